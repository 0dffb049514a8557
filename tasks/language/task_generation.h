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
  int count = 8;                      // number of tasks to ask for, 1 to 200
  int tasks_per_question = 8;         // tasks per answer, 1 to 100; longer answers are cut off
  int repairs = 3;                    // repair attempts per subtask, 0 to 10
  std::optional<double> temperature;  // see llm::ChatRequest
  std::optional<std::uint64_t> seed;
  DescriptionBounds bounds;

  // Returns false if a value is out of range, and describes it in `error` unless null.
  bool IsValid(std::string* error) const;
};

struct GeneratedTasks {
  std::vector<Task> tasks;
  core::Findings findings;  // places: "task" or "task/subtask", or empty
  int questions = 0;        // questions sent to the model, repairs included
  int repaired = 0;         // subtasks that were invalid at first and are valid now
};

// Generates tasks for `scene` with `model`. Each subtask is verified. A subtask with errors is sent
// back to the model together with the errors, up to `repairs` times; every earlier program is kept
// in Subtask::attempts. A subtask that still has errors keeps its last program and its findings,
// which makes its task invalid, and is reported ("llm-gave-up"). All tasks that the model proposed
// are returned. If an answer holds no program, the question is asked once more.
//
// Findings in addition to those of ReadTaskAnswer (task_answer.h) and DescribeScene: "llm-gave-up"
// (error), "llm-no-tasks" (error: no answer held a task), "llm-fewer-tasks" (info),
// "llm-answer-cut" (warning: the server ended an answer early), "llm-failed" (error: the server's
// message when it failed after some tasks had been proposed; those are returned without further
// repairs).
//
// Throws core::Error if the options are invalid, an asset has an invalid name, or the model fails
// before it has proposed a task. Throws core::Cancelled after Ctrl-C at any time; a transcript
// holds the answers so far. Passes on exceptions of `verify`.
GeneratedTasks GenerateTasksByModel(std::span<const NamedModel> scene,
                                    const TaskGenerationOptions& options, llm::ChatModel* model,
                                    const VerifySubtask& verify,
                                    core::Progress* progress = nullptr);

}  // namespace simwright::tasks
