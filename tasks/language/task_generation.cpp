#include "tasks/language/task_generation.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/error.h"
#include "tasks/language/answer_text.h"
#include "tasks/language/program_blocks.h"
#include "tasks/language/task_answer.h"
#include "tasks/language/task_question.h"
#include "tasks/task_names.h"

namespace simwright::tasks {
namespace {

// Bytes of an answer that are repeated to the model, and that are kept if it holds no program.
constexpr std::size_t kLongestKeptAnswer = 64u << 10;

// Returns the findings that prevent training on a program.
core::Findings ErrorsOf(const core::Findings& findings) {
  core::Findings errors;
  for (const core::Finding& finding : findings) {
    if (finding.severity == core::Severity::kError) errors.push_back(finding);
  }
  return errors;
}

void RequireNames(std::span<const NamedModel> scene) {
  if (scene.empty()) throw core::Error("there is no asset", "tasks", "give at least one");
  std::set<std::string> names;
  for (const NamedModel& asset : scene) {
    if (!IsAssetName(asset.name)) {
      throw core::Error("the name is not valid for an asset", asset.name,
                        "a letter, then letters, digits, '_', '-'");
    }
    if (!names.insert(asset.name).second) {
      throw core::Error("two assets have this name", asset.name, "give one another name");
    }
  }
}

// One generation run: the model, the questions asked, and the results.
class TaskGeneration {
 public:
  TaskGeneration(std::span<const NamedModel> scene, const TaskGenerationOptions& options,
                 llm::ChatModel* model, const VerifySubtask& verify, core::Progress* progress)
      : scene_(scene), options_(options), model_(*model), verify_(verify), progress_(progress) {
    SceneDescription description = DescribeScene(scene, options.bounds);
    description_ = std::move(description.text);
    Report(description.findings);
  }

  GeneratedTasks Run() {
    while (missing() > 0 && !failed_) {
      std::vector<Task> proposed = Propose(std::min(missing(), options_.tasks_per_question));
      asked_ += std::min(missing(), options_.tasks_per_question);
      for (Task& task : proposed) {
        core::CheckCancelled();
        Complete(&task);
        result_.tasks.push_back(std::move(task));
      }
    }
    if (result_.tasks.empty()) {
      Report("llm-no-tasks", core::Severity::kError, "",
             Source() + " gave no task with a reward function", 0.0);
    } else if (static_cast<int>(result_.tasks.size()) < options_.count && !failed_) {
      Report("llm-fewer-tasks", core::Severity::kInfo, "",
             Source() + " gave " + std::to_string(result_.tasks.size()) + " of " +
                 std::to_string(options_.count) + " tasks",
             static_cast<double>(result_.tasks.size()));
    }
    return std::move(result_);
  }

 private:
  int missing() const { return options_.count - asked_; }

  std::string Source() const {
    return model_.name().empty() ? "the language model" : "the language model " + model_.name();
  }

  void Report(const core::Findings& findings, const std::string& place = "") {
    for (core::Finding finding : findings) {
      if (finding.place.empty()) finding.place = place;
      result_.findings.push_back(std::move(finding));
    }
  }

  void Report(const std::string& code, core::Severity severity, const std::string& place,
              const std::string& sentence, double figure) {
    result_.findings.push_back({code, severity, place, sentence, figure});
  }

  // Returns the answer's text; nullopt if the model failed after some tasks were generated.
  std::optional<std::string> Ask(llm::ChatRequest* request) {
    request->temperature = options_.temperature;
    request->seed = options_.seed;
    try {
      const llm::ChatAnswer answer = model_.Ask(*request, progress_);
      ++result_.questions;
      Report(model_.TakeFindings(), request->task);
      if (answer.finish_reason == "length") {
        Report("llm-answer-cut", core::Severity::kWarning, request->task,
               "the server ended the answer before it was complete", 0.0);
      }
      request->messages.push_back(
          {llm::Role::kAssistant, answer.text.substr(0, kLongestKeptAnswer), {}});
      return answer.text;
    } catch (const core::Error& error) {
      if (result_.tasks.empty() && !proposed_) throw;
      failed_ = true;
      Report(model_.TakeFindings(), request->task);
      Report("llm-failed", core::Severity::kError, request->task, error.what(), 0.0);
      return std::nullopt;
    }
  }

  // Returns the tasks of one question, which is asked twice if the first answer holds no program.
  std::vector<Task> Propose(int count) {
    std::vector<std::string> have;
    for (const Task& task : result_.tasks) have.push_back(task.name);
    llm::ChatRequest request = TaskQuestion(description_, count, have);
    std::vector<Task> proposed;
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::optional<std::string> text = Ask(&request);
      if (!text) break;
      TaskAnswer answer = ReadTaskAnswer(*text);
      for (core::Finding& finding : answer.findings) {  // an answer without tasks is not fatal
        finding.severity = std::min(finding.severity, core::Severity::kWarning);
      }
      Report(answer.findings, request.task);
      if (answer.has_program()) {
        proposed = std::move(answer.tasks);
        break;
      }
      if (!answer.tasks.empty()) proposed = std::move(answer.tasks);
      proposed_ = proposed_ || !proposed.empty();
      request.messages.push_back({llm::Role::kUser, RetryQuestion(), {}});
    }
    proposed_ = proposed_ || !proposed.empty();
    return WithUniqueNames(std::move(proposed));
  }

  // Returns the tasks under names that differ from those of earlier tasks.
  std::vector<Task> WithUniqueNames(std::vector<Task> tasks) {
    for (Task& task : tasks) {
      const std::string unique = UniqueName(task.name, &names_);
      if (unique != task.name) {
        Report("task-renamed", core::Severity::kWarning, unique,
               "another task already has the name " + task.name, 0.0);
      }
      task.name = unique;
      task.source = model_.name().empty() ? "language model" : model_.name();
    }
    return tasks;
  }

  // Stores the assets that the task's programs name, in the scene's order.
  void NameAssets(Task* task) const {
    task->assets.clear();
    for (const NamedModel& asset : scene_) {
      const bool named =
          std::any_of(task->subtasks.begin(), task->subtasks.end(), [&](const Subtask& subtask) {
            return subtask.program.find("\"" + asset.name + "\"") != std::string::npos ||
                   subtask.program.find("'" + asset.name + "'") != std::string::npos;
          });
      if (named) task->assets.push_back(asset.name);
    }
  }

  void Verify(Task* task, Subtask* subtask) {
    NameAssets(task);
    if (subtask->program.empty()) {
      subtask->findings = {{"program-missing", core::Severity::kError, "",
                            "the language model gave no reward function", 0.0}};
    } else {
      subtask->findings = verify_(*task, subtask);
    }
  }

  void Complete(Task* task) {
    for (Subtask& subtask : task->subtasks) {
      Verify(task, &subtask);
      const bool valid = subtask.valid();
      if (!valid && !failed_) Repair(task, &subtask);
      if (subtask.valid()) {
        result_.repaired += valid ? 0 : 1;
        continue;
      }
      GiveUp(task, subtask);
    }
  }

  // Keeps the task with its findings and reports why it cannot be trained.
  void GiveUp(Task* task, const Subtask& subtask) {
    const core::Findings errors = ErrorsOf(subtask.findings);
    const std::string count = std::to_string(errors.size());
    const std::size_t repairs = subtask.attempts.size();
    const core::Finding finding{"llm-gave-up", core::Severity::kError, subtask.name,
                                "has " + count + (errors.size() == 1 ? " error" : " errors") +
                                    " after " + std::to_string(repairs) +
                                    (repairs == 1 ? " repair" : " repairs") +
                                    (errors.empty() ? "" : ", first: " + errors.front().sentence),
                                static_cast<double>(errors.size())};
    task->findings.push_back(finding);
    result_.findings.push_back(finding);
    result_.findings.back().place = task->name + "/" + subtask.name;
  }

  void Repair(Task* task, Subtask* subtask) {
    llm::ChatRequest request = RepairQuestion(description_, *task, *subtask, subtask->findings);
    for (int repair = 0; repair < options_.repairs && !subtask->valid(); ++repair) {
      const std::optional<std::string> text = Ask(&request);
      if (!text) return;
      const std::string program = ReadProgramAnswer(*text);
      const std::string before = subtask->program;
      if (program.empty()) {
        core::Findings why = {{"answer-no-program", core::Severity::kError, "",
                               "no reward function was found in the answer", 0.0}};
        core::Findings ignored;
        subtask->attempts.push_back(
            {PlainAnswer(std::string_view(*text).substr(0, kLongestKeptAnswer), &ignored), why});
      } else {
        subtask->attempts.push_back({before, subtask->findings});
        subtask->program = program;
        const std::string success = SuccessExpression(program);
        if (!success.empty()) subtask->success = success;
        Verify(task, subtask);
      }
      request.messages.push_back(
          {llm::Role::kUser, RepairRetryQuestion(program, before, subtask->findings), {}});
    }
  }

  std::span<const NamedModel> scene_;
  const TaskGenerationOptions& options_;
  llm::ChatModel& model_;
  const VerifySubtask& verify_;
  core::Progress* progress_;
  std::string description_;
  GeneratedTasks result_;
  std::set<std::string> names_;
  int asked_ = 0;          // tasks asked for
  bool proposed_ = false;  // there are tasks that must not be lost
  bool failed_ = false;    // the model failed and is not asked again
};

}  // namespace

bool TaskGenerationOptions::IsValid(std::string* error) const {
  const auto refuse = [error](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (count < 1 || count > 200) return refuse("the number of tasks must be between 1 and 200");
  if (tasks_per_question < 1 || tasks_per_question > 100) {
    return refuse("a question must ask for 1 to 100 tasks");
  }
  if (repairs < 0 || repairs > 10) return refuse("the number of repairs must be between 0 and 10");
  return true;
}

GeneratedTasks GenerateTasksByModel(std::span<const NamedModel> scene,
                                    const TaskGenerationOptions& options, llm::ChatModel* model,
                                    const VerifySubtask& verify, core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "tasks");
  RequireNames(scene);
  return TaskGeneration(scene, options, model, verify, progress).Run();
}

}  // namespace simwright::tasks
