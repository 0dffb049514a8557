#include "tasks/language/json_tasks.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/json.h"
#include "llm/json_text.h"
#include "tasks/language/answer_text.h"
#include "tasks/language/program_blocks.h"
#include "tasks/language/stated_goal.h"

namespace simwright::tasks {
namespace {

using core::Json;

constexpr int kDeepestAnswer = 6;  // nesting levels of objects around tasks

// Normalizes a key: "Task Description" and "task_description" are equal.
std::string PlainKey(std::string_view key) {
  std::string plain;
  for (const char c : Lower(key)) {
    if (c >= 'a' && c <= 'z') plain += c;
  }
  return plain;
}

const Json* Member(const Json& object, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    for (const auto& [key, value] : object.items()) {
      if (PlainKey(key) == name) return &value;
    }
  }
  return nullptr;
}

std::string TextOf(const Json* json) {
  return json != nullptr && json->is_string() ? Unquoted(json->get<std::string>()) : "";
}

// Removes a code fence inside a JSON string.
std::string WithoutFence(const std::string& program) {
  const std::string_view text = Trimmed(program);
  if (!text.starts_with("```")) return program;
  const std::size_t begin = text.find('\n');
  if (begin == std::string_view::npos) return "";
  const std::size_t end = text.rfind("```");
  return std::string(text.substr(begin + 1, end > begin ? end - begin - 1 : text.size()));
}

// Returns a program given as text or as lines, directly or one level down ({"code": ...}).
std::string ProgramOf(const Json* json, int depth = 0) {
  if (json == nullptr) return "";
  std::string program;
  if (json->is_string()) {
    program = WithoutFence(json->get<std::string>());
  } else if (json->is_array()) {
    for (const Json& line : *json) {
      if (!line.is_string()) return "";
      program += line.get<std::string>() + (line.get<std::string>().ends_with('\n') ? "" : "\n");
    }
  } else if (json->is_object() && depth == 0) {
    return ProgramOf(Member(*json, {"code", "program", "function", "python", "source"}), 1);
  }
  const bool code =
      program.find("def ") != std::string::npos || program.find("return") != std::string::npos;
  return code ? program + (program.ends_with('\n') ? "" : "\n") : "";
}

const Json* ProgramMember(const Json& object) {
  return Member(object,
                {"program", "rewardfunction", "rewardcode", "reward", "code", "computereward",
                 "function", "rewardprogram", "pythoncode", "python", "rewardfn"});
}

const Json* SubtasksMember(const Json& object) {
  return Member(object, {"subtasks", "subtask", "decomposition", "subtaskdecomposition", "steps"});
}

std::string TitleMember(const Json& object) {
  for (const std::string_view name :
       {"name", "taskname", "subtaskname", "task", "subtask", "title", "tasktitle"}) {
    const std::string title = TextOf(Member(object, {name}));
    if (!title.empty()) return title;
  }
  return "";
}

Subtask SubtaskOf(const Json& object, const std::string& title) {
  Subtask subtask;
  subtask.name = TitleMember(object);
  if (subtask.name.empty()) subtask.name = title;
  subtask.description =
      TextOf(Member(object, {"description", "subtaskdescription", "taskdescription"}));
  subtask.program = ProgramOf(ProgramMember(object));
  subtask.success = TextOf(
      Member(object, {"success", "successcondition", "successcriterion", "successcriteria"}));
  if (subtask.success.empty()) subtask.success = SuccessExpression(subtask.program);
  if (const Json* goal = Member(object, {"goal", "goalposition", "targetposition"})) {
    subtask.goal = StatedGoal(core::JsonLine(*goal, core::InvalidUtf8::kReplace));
  }
  return subtask;
}

// Returns the members of `object` in the order of their keys in the answer, which the JSON parser
// does not keep.
std::vector<std::pair<std::string, const Json*>> InOrder(const Json& object,
                                                         std::string_view answer) {
  std::vector<std::pair<std::size_t, std::pair<std::string, const Json*>>> placed;
  for (const auto& [key, value] : object.items()) {
    placed.push_back({answer.find('"' + key + '"'), {key, &value}});
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::string, const Json*>> members;
  for (auto& [place, member] : placed) members.push_back(std::move(member));
  return members;
}

// Returns the subtasks, given as objects, as titles, or as a map from title to object or program.
std::vector<Subtask> SubtasksOf(const Json& json, std::string_view answer) {
  std::vector<Subtask> subtasks;
  const auto add = [&](const std::string& key, const Json& value) {
    if (value.is_object()) {
      subtasks.push_back(SubtaskOf(value, key));
    } else if (value.is_string() || value.is_array()) {
      Subtask subtask;
      subtask.program = ProgramOf(&value);
      subtask.success = SuccessExpression(subtask.program);
      subtask.name = subtask.program.empty() && value.is_string() && key.empty()
                         ? Unquoted(value.get<std::string>())
                         : key;
      if (!subtask.name.empty() || !subtask.program.empty()) subtasks.push_back(subtask);
    }
  };
  if (json.is_array()) {
    for (const Json& element : json) add("", element);
  } else if (json.is_object()) {
    const bool single = ProgramMember(json) != nullptr;
    if (single) add("", json);
    if (single) return subtasks;
    for (const auto& [key, value] : InOrder(json, answer)) add(key, *value);
  }
  return subtasks;
}

// Assigns programs listed beside the subtasks, in order or by title.
void AddProgramsBeside(const Json& object, std::vector<Subtask>* subtasks) {
  const Json* beside = Member(
      object, {"rewardfunctions", "rewards", "programs", "functions", "rewardfunction", "reward"});
  if (beside == nullptr || !(beside->is_array() || beside->is_object())) return;
  std::size_t next = 0;
  for (const auto& member : beside->items()) {
    const std::string& key = member.key();
    const Json& value = member.value();
    const auto named = std::find_if(subtasks->begin(), subtasks->end(), [&](const Subtask& s) {
      return beside->is_object() && Lower(s.name) == Lower(key);
    });
    Subtask* subtask = named != subtasks->end()  ? &*named
                       : next < subtasks->size() ? &(*subtasks)[next]
                                                 : nullptr;
    ++next;
    if (subtask == nullptr || !subtask->program.empty()) continue;
    subtask->program = value.is_object() ? ProgramOf(ProgramMember(value)) : ProgramOf(&value);
    if (subtask->success.empty()) subtask->success = SuccessExpression(subtask->program);
  }
}

bool IsTask(const Json& json) {
  if (!json.is_object()) return false;
  if (!ProgramOf(ProgramMember(json)).empty()) return true;
  const Json* subtasks = SubtasksMember(json);
  return subtasks != nullptr && (subtasks->is_array() || subtasks->is_object());
}

Task TaskOf(const Json& json, const std::string& title, std::string_view answer) {
  Task task;
  task.name = TitleMember(json);
  if (task.name.empty()) task.name = title;
  task.description = TextOf(Member(json, {"taskdescription", "description"}));
  if (const Json* subtasks = SubtasksMember(json)) {
    task.subtasks = SubtasksOf(*subtasks, answer);
    AddProgramsBeside(json, &task.subtasks);
  }
  if (task.subtasks.empty()) {
    task.subtasks.push_back(SubtaskOf(json, task.name));
    task.subtasks.back().name = task.name;
  }
  return task;
}

// Descends to the objects that are tasks; `key` is the key of the current object.
void Collect(const Json& json, const std::string& key, std::string_view answer, int depth,
             std::vector<Task>* tasks) {
  if (depth > kDeepestAnswer) return;
  if (IsTask(json)) {
    tasks->push_back(TaskOf(json, key, answer));
  } else if (json.is_array()) {
    for (const Json& element : json) Collect(element, "", answer, depth + 1, tasks);
  } else if (json.is_object()) {
    for (const auto& [name, value] : InOrder(json, answer)) {
      if (!value->is_primitive()) Collect(*value, name, answer, depth + 1, tasks);
    }
  }
}

// Escapes line breaks inside quotes and triple quotes as JSON requires.
std::string Repaired(std::string_view text) {
  std::string mended;
  bool quoted = false, triple = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (text.substr(i, 3) == "\"\"\"" && (triple || !quoted)) {
      mended += '"';
      triple = !triple;
      quoted = triple;
      i += 2;
    } else if (quoted && c == '\\' && i + 1 < text.size()) {
      mended += text.substr(i++, 2);
    } else if (triple && c == '"') {
      mended += "\\\"";
    } else if (quoted && c == '\n') {
      mended += "\\n";
    } else if (quoted && c == '\t') {
      mended += "\\t";
    } else {
      if (c == '"') quoted = !quoted;
      mended += c;
    }
  }
  return mended;
}

std::vector<Task> TasksInText(std::string_view text) {
  std::vector<Task> tasks;
  for (const Json& json : llm::JsonInText(text)) Collect(json, "", text, 0, &tasks);
  return tasks;
}

}  // namespace

std::vector<Task> TasksInJson(std::string_view answer) {
  // Code and lists contain many brackets: only text with keys can hold tasks.
  if (answer.find('{') == std::string_view::npos || answer.find(':') == std::string_view::npos) {
    return {};
  }
  std::vector<Task> tasks = TasksInText(answer);
  if (!tasks.empty()) return tasks;
  return TasksInText(Repaired(answer.substr(answer.find_first_of("{["))));
}

}  // namespace simwright::tasks
