#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "tasks/language/scene_description.h"
#include "tasks/subtask_verification.h"
#include "tasks/task.h"

namespace simwright::tasks {

struct TaskGenerationOptions {
  int count = 8;               // tasks asked for, 1 to 200
  int most_in_a_question = 8;  // tasks one answer should hold, 1 to 100; longer ones are cut off
  int repairs = 3;             // of one subtask, 0 to 10
  std::optional<double> temperature;  // see llm::ChatRequest
  std::optional<std::uint64_t> seed;
  DescriptionBounds bounds;

  // False where a number is out of its range; says which in `error` unless null.
  bool IsValid(std::string* error) const;
};

struct GeneratedTasks {
  std::vector<Task> tasks;
  core::Findings findings;  // places: "task" or "task/subtask", or empty
  int questions = 0;        // asked of the model, repairs included
  int repaired = 0;         // subtasks that were not sound at first and are now
};

// Tasks for `scene` that `model` proposes. Each subtask is verified; what has errors goes back to
// the model with them, up to `repairs` times, and every earlier program stays in
// Subtask::attempts. One that still has errors keeps its last program and its findings, so that
// its task is not sound, and is reported ("llm-gave-up"); the tasks that the model gave are all
// returned. An answer without any program is asked for once more.
//
// Findings beside those of the reader (task_answer.h) and of DescribeScene: "llm-gave-up" (error),
// "llm-no-tasks" (error: no answer held any), "llm-fewer-tasks" (info), "llm-answer-cut"
// (warning: the server ended an answer early), "llm-failed" (error: what the server said when it
// failed after tasks were there; these are returned, and not repaired any more).
//
// Throws core::Error where the options are not valid, an asset's name cannot be one, or the model
// fails before there is a task; core::Cancelled after Ctrl-C at any time: a transcript holds the
// answers so far; and what `verify` throws.
GeneratedTasks GenerateTasksByModel(std::span<const NamedModel> scene,
                                    const TaskGenerationOptions& options, llm::ChatModel* model,
                                    const VerifySubtask& verify,
                                    core::Progress* progress = nullptr);

}  // namespace simwright::tasks
