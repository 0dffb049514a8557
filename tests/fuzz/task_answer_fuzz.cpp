// What language models say of tasks, and tasks.json: tasks under safe names that can be written and
// read back, or core::Error for a file that is none; nothing else.
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>

#include "core/error.h"
#include "tasks/language/task_answer.h"
#include "tasks/task_file.h"
#include "tasks/task_names.h"

namespace {

using namespace simwright::tasks;

void RequireOneOf(std::set<std::string>* names, const std::string& name) {
  if (name.empty() || SafeName(name) != name || !names->insert(name).second) std::abort();
}

void RequireSound(const TaskAnswer& answer) {
  if (answer.tasks.size() > 100) std::abort();
  if (!answer.has_program() && answer.findings.empty()) std::abort();
  std::set<std::string> tasks;
  for (const Task& task : answer.tasks) {
    RequireOneOf(&tasks, task.name);
    if (task.subtasks.empty() || task.subtasks.size() > 30) std::abort();
    std::set<std::string> subtasks;
    for (const Subtask& subtask : task.subtasks) RequireOneOf(&subtasks, subtask.name);
  }
}

// The same bytes after one more way there and back.
void RequireRoundTrip(const TaskSet& set) {
  const std::string text = TaskFileText(set, "/d");
  if (TaskFileText(ReadTaskFileText(text, "tasks.json", "/d"), "/d") != text) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const TaskAnswer answer = ReadTaskAnswer(text);
  RequireSound(answer);
  RequireRoundTrip({{}, answer.tasks});
  ReadProgramAnswer(text);
  try {
    const TaskSet set = ReadTaskFileText(text, "tasks.json", "/d");
    RequireRoundTrip(set);
  } catch (const simwright::core::Error&) {
  }
  return 0;
}
