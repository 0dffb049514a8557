#include "tasks/language/task_answer.h"

#include <algorithm>
#include <set>

#include "tasks/language/answer_outline.h"
#include "tasks/language/answer_text.h"
#include "tasks/language/json_tasks.h"
#include "tasks/language/outline_tasks.h"
#include "tasks/language/program_blocks.h"
#include "tasks/task_names.h"

namespace simwright::tasks {
namespace {

constexpr std::size_t kMostAnswerTasks = 100, kMostSubtasks = 30;
constexpr std::size_t kLongestSentence = 2000;  // bytes of a description

std::size_t ProgramsOf(const std::vector<Task>& tasks) {
  std::size_t programs = 0;
  for (const Task& task : tasks) {
    for (const Subtask& subtask : task.subtasks) programs += subtask.program.empty() ? 0 : 1;
  }
  return programs;
}

// Assigns the programs of `from` in order to the subtasks of `tasks` if the counts match: some
// answers plan in JSON and write the functions below it.
void FillInOrder(const std::vector<Task>& from, std::vector<Task>* tasks) {
  std::vector<std::string> programs;
  for (const Task& task : from) {
    for (const Subtask& subtask : task.subtasks) {
      if (!subtask.program.empty()) programs.push_back(subtask.program);
    }
  }
  std::vector<Subtask*> subtasks;
  for (Task& task : *tasks) {
    for (Subtask& subtask : task.subtasks) subtasks.push_back(&subtask);
  }
  if (programs.size() != subtasks.size() || ProgramsOf(*tasks) > 0) return;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    subtasks[i]->program = programs[i];
    if (subtasks[i]->success.empty()) subtasks[i]->success = SuccessExpression(programs[i]);
  }
}

// Returns `text` cut to the bound at a character boundary.
std::string Bounded(std::string text) {
  if (text.size() <= kLongestSentence) return text;
  std::size_t end = kLongestSentence;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

// Returns the name with blanks: "open_door" gives "open door".
std::string Spoken(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// Returns a safe, unused name from a title or else a number; reports a name that is already taken.
std::string ClaimName(const std::string& title, const std::string& kind, std::size_t number,
                      std::set<std::string>* taken, core::Findings* findings) {
  std::string name = SafeName(title);
  const bool numbered = name.empty();
  if (numbered) name = kind + "_" + std::to_string(number);
  const std::string unique = UniqueName(name, taken);
  if (unique != name && !numbered) {
    findings->push_back({"task-renamed", core::Severity::kWarning, unique,
                         "another " + kind + " already has the name " + name, 0.0});
  }
  return unique;
}

void Describe(const std::string& title, const std::string& name, std::string* description) {
  if (description->empty()) *description = title.empty() ? Spoken(name) : title;
  *description = Bounded(std::move(*description));
}

void Bound(std::vector<Task>* tasks, core::Findings* findings) {
  if (tasks->size() > kMostAnswerTasks) {
    findings->push_back({"answer-too-many-tasks", core::Severity::kWarning, "",
                         "only the first " + std::to_string(kMostAnswerTasks) + " tasks are kept",
                         static_cast<double>(tasks->size())});
    tasks->resize(kMostAnswerTasks);
  }
  for (Task& task : *tasks) {
    if (task.subtasks.size() <= kMostSubtasks) continue;
    findings->push_back({"answer-too-many-tasks", core::Severity::kWarning, task.name,
                         "only the first " + std::to_string(kMostSubtasks) + " subtasks are kept",
                         static_cast<double>(task.subtasks.size())});
    task.subtasks.resize(kMostSubtasks);
  }
}

void NameAll(std::vector<Task>* tasks, core::Findings* findings) {
  std::set<std::string> task_names;
  for (std::size_t i = 0; i < tasks->size(); ++i) {
    Task& task = (*tasks)[i];
    const std::string title = task.name;
    task.name = ClaimName(title, "task", i + 1, &task_names, findings);
    Describe(title, task.name, &task.description);
    std::set<std::string> subtask_names;
    for (std::size_t k = 0; k < task.subtasks.size(); ++k) {
      Subtask& subtask = task.subtasks[k];
      const std::string of_subtask = subtask.name;
      subtask.name = ClaimName(of_subtask, "subtask", k + 1, &subtask_names, findings);
      if (task.subtasks.size() == 1 && subtask.description.empty()) {
        subtask.description = task.description;
      }
      Describe(of_subtask, subtask.name, &subtask.description);
      subtask.success = Bounded(std::move(subtask.success));
    }
  }
}

}  // namespace

bool TaskAnswer::has_program() const {
  return ProgramsOf(tasks) > 0;
}

TaskAnswer ReadTaskAnswer(std::string_view answer) {
  TaskAnswer read;
  const std::string plain = PlainAnswer(answer, &read.findings);
  if (Trimmed(plain).empty()) {
    read.findings.push_back(
        {"answer-empty", core::Severity::kError, "", "the answer is empty", 0.0});
    return read;
  }
  read.tasks = TasksInOutline(ReadOutline(plain));
  std::vector<Task> in_json = TasksInJson(plain);
  FillInOrder(read.tasks, &in_json);
  if (!in_json.empty() && ProgramsOf(in_json) >= ProgramsOf(read.tasks)) {
    read.tasks = std::move(in_json);
  }
  Bound(&read.tasks, &read.findings);
  NameAll(&read.tasks, &read.findings);
  if (!read.has_program()) {
    read.findings.push_back({"answer-no-program", core::Severity::kError, "",
                             "no reward function was found in the answer", 0.0});
  }
  return read;
}

std::string ReadProgramAnswer(std::string_view answer) {
  for (const Task& task : ReadTaskAnswer(answer).tasks) {
    for (const Subtask& subtask : task.subtasks) {
      if (!subtask.program.empty()) return subtask.program;
    }
  }
  return "";
}

}  // namespace simwright::tasks
