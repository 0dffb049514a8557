#include "tasks/verification/subtask_verifier.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/error.h"
#include "reward/reward_program.h"
#include "tasks/language/program_blocks.h"
#include "tasks/verification/action_sampling.h"
#include "tasks/verification/path_search.h"
#include "tasks/verification/program_trial.h"
#include "tasks/verification/start_planning.h"
#include "tasks/verification/title_direction.h"

namespace simwright::tasks {
namespace {

using core::Severity;

// Returns "line:column" of the last return, the place of findings about a program's behaviour.
std::string LastReturn(const std::string& source) {
  std::istringstream lines(source);
  std::string place;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos || line.compare(at, 6, "return") != 0) continue;
    place = std::to_string(number) + ":" + std::to_string(at + 1);
  }
  return place;
}

std::string Rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

bool HasError(const core::Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const core::Finding& finding) {
    return finding.severity == Severity::kError;
  });
}

// Promotes to errors the warnings that are acceptable in a file but not in a task.
void PromoteToErrors(core::Findings* findings) {
  for (core::Finding& finding : *findings) {
    if (finding.code == "constant-reward" || finding.code == "constant-success" ||
        finding.code == "self-distance" || finding.code == "norm-over-environments" ||
        finding.code == "reduction-over-environments" || finding.code == "shared-reward") {
      finding.severity = Severity::kError;
    }
  }
}

// Returns the direction of the joint that moved by the largest share of its range, relative to its
// rest.
TitleDirection DirectionOf(const WorldModel& model, const WorldState& from, const WorldState& to) {
  double most = 0.05;
  TitleDirection direction = TitleDirection::kNone;
  for (std::size_t t = 0; t < model.objects.size(); ++t) {
    for (std::size_t j = 0; j < model.objects[t].joints.size(); ++j) {
      const ObjectJoint& joint = model.objects[t].joints[j];
      const double share =
          std::abs(to.joints[t][j] - from.joints[t][j]) / std::max(joint.upper - joint.lower, 1e-9);
      if (share <= most) continue;
      most = share;
      const bool away =
          std::abs(to.joints[t][j] - joint.rest()) > std::abs(from.joints[t][j] - joint.rest());
      direction = away ? TitleDirection::kAway : TitleDirection::kBack;
    }
  }
  return direction;
}

// The verification of one program from one start.
class Trial {
 public:
  Trial(const WorldModel& model, const VerificationOptions& options,
        const reward::RewardProgram& program, const Subtask& subtask, const std::string& title)
      : model_(model),
        options_(options),
        program_(program),
        subtask_(subtask),
        asked_(DirectionOfTitle(title)),
        place_(LastReturn(subtask.program)),
        start_(StateOf(model, subtask.start, subtask.goal)) {}

  core::Findings Run() {
    const ActionSequences actions = SampleActions(model_, start_, program_.slots());
    EvaluateRandomStates();
    if (program_.has_success() && SucceedsAtStart()) return std::move(findings_);
    path_ = Find(actions.single, false);
    if (!path_ || !path_->reachable) {
      std::optional<SuccessPath> longer = Find(actions.chained, true);
      if (longer && (longer->reachable || !path_)) path_ = std::move(longer);
    }
    if (range_.finite && range_.any && range_.highest - range_.lowest <= kSame) {
      Report("constant-reward", Severity::kError,
             "the reward is the same number in every state: nothing can be learned from it");
    }
    if (!range_.finite) {
      Report("reward-not-finite", Severity::kError,
             "the reward is infinite or no number in some states: guard divisions, roots and "
             "logarithms");
    }
    if (!program_.has_success()) {
      if (options_.needs_success) {
        Report("no-success", Severity::kError,
               "the function gives no success: end it with 'return reward, success'");
      }
      return std::move(findings_);
    }
    if (range_.always_success) {
      Report("constant-success", Severity::kError, "success holds in every state");
    } else if (!path_) {
      ReportNoPath(actions);
    } else {
      ReportPath();
    }
    return std::move(findings_);
  }

  const std::optional<SuccessPath>& path() const { return path_; }

 private:
  static constexpr double kSame = 1e-7;

  void Report(const std::string& code, Severity severity, const std::string& sentence,
              double figure = 0.0) {
    findings_.push_back({code, severity, place_, sentence, figure});
  }

  std::optional<SuccessPath> Find(const std::vector<std::vector<Action>>& sequences, bool early) {
    return FindSuccessPath(program_, model_, start_, subtask_.start.world_from_robot, sequences,
                           early, &range_);
  }

  void EvaluateRandomStates() {
    core::Rng rng = core::StreamRng(options_.seed, 1);
    const std::vector<WorldState> states =
        RandomStates(model_, start_, program_.slots(), options_.random_states, rng);
    const TrialResult trial = RunOnStates(program_, model_, states, false);
    for (std::size_t i = 0; i < states.size(); ++i) {
      range_.Add(trial.reward[i], trial.success[i] != 0);
    }
  }

  // Returns true, and reports a finding, if success holds at the start.
  bool SucceedsAtStart() {
    const TrialResult trial = RunOnStates(program_, model_, {start_}, false);
    range_.Add(trial.reward[0], trial.success[0] != 0);
    if (trial.success[0] == 0) return false;
    if (range_.always_success) {
      Report("constant-success", Severity::kError, "success holds in every state");
      return true;
    }
    if (asked_ != TitleDirection::kNone && SucceedsFromOtherEnd()) {
      ReportTitle(asked_ == TitleDirection::kAway ? TitleDirection::kBack : TitleDirection::kAway);
      return true;
    }
    Report("success-at-start", Severity::kError,
           "success holds before anything was done: ask for a change, or start elsewhere");
    return true;
  }

  // Returns true if the program moves the joint opposite to the title: with every joint that it
  // reads at the other limit there is a path to success.
  bool SucceedsFromOtherEnd() {
    WorldState other = start_;
    bool any = false;
    for (const reward::RewardSlot& slot : program_.slots()) {
      const int object = model_.Find(slot.asset);
      if (object < 0 || slot.part.empty()) continue;
      const auto t = static_cast<std::size_t>(object);
      const int joint = model_.objects[t].FindJoint(slot.part);
      if (joint < 0) continue;
      const auto j = static_cast<std::size_t>(joint);
      const ObjectJoint& moved = model_.objects[t].joints[j];
      const bool open = std::abs(start_.joints[t][j] - moved.far()) <
                        std::abs(start_.joints[t][j] - moved.rest());
      other.joints[t][j] = open ? moved.rest() : moved.far();
      any = true;
    }
    if (!any) return false;
    const ActionSequences actions = SampleActions(model_, other, program_.slots());
    const std::optional<SuccessPath> path = FindSuccessPath(
        program_, model_, other, subtask_.start.world_from_robot, actions.single, true, nullptr);
    return path.has_value();
  }

  void ReportTitle(TitleDirection done) {
    const bool away = done == TitleDirection::kAway;
    Report("title-direction", Severity::kError,
           std::string("the title asks for the joint to go ") +
               (away ? "back to its rest (closed, off)" : "away from its rest (open, on)") +
               ", the program's success for the other way");
  }

  void ReportNoPath(const ActionSequences& actions) {
    if (Find(actions.beyond_limits, true)) {
      Report("success-outside-limits", Severity::kError,
             "success is only reached beyond a joint's limits: measure it against "
             "env.get_limits_by_joint_name");
      return;
    }
    if (Find(actions.too_far, true)) {
      Report("success-out-of-reach", Severity::kError,
             "success is only reached where the arm does not get to");
      return;
    }
    if (range_.ever_success) {
      Report("no-path", Severity::kWarning,
             "no path to success was found: joints moved, things lifted, carried, placed, pushed "
             "and tilted do not bring it about");
      return;
    }
    Report("success-never", Severity::kError, "success holds in no state that was tried");
  }

  void ReportPath() {
    if (!path_->reachable) {
      Report("success-out-of-reach", Severity::kError,
             "the arm does not reach where success takes it");
    }
    if (path_->agreement < options_.against) {
      Report("sign-against-success", Severity::kError,
             "the reward falls while success comes nearer (rank correlation " +
                 Rounded(path_->agreement) + "): is a sign wrong?",
             path_->agreement);
    } else if (path_->agreement <= options_.unclear) {
      Report("sign-unclear", Severity::kWarning,
             "the reward does not rise while success comes nearer (rank correlation " +
                 Rounded(path_->agreement) + ")",
             path_->agreement);
    }
    const TitleDirection done =
        DirectionOf(model_, path_->motion.states.front(), path_->motion.states[path_->first]);
    if (asked_ != TitleDirection::kNone && done != TitleDirection::kNone && done != asked_) {
      ReportTitle(done);
    }
  }

  const WorldModel& model_;
  const VerificationOptions& options_;
  const reward::RewardProgram& program_;
  const Subtask& subtask_;
  TitleDirection asked_;
  std::string place_;
  WorldState start_;
  RewardRange range_;
  std::optional<SuccessPath> path_;
  core::Findings findings_;
};

bool ReadsGoal(const reward::RewardProgram& program) {
  return std::any_of(program.slots().begin(), program.slots().end(),
                     [](const reward::RewardSlot& slot) {
                       return slot.input == reward::RewardInput::kGoalPosition;
                     });
}

// Returns true if `start` places anything, and every object that the program reads.
bool PlacesAllObjects(const InitialState& start, const reward::RewardProgram& program) {
  const auto& placed = start.placements;
  return !placed.empty() &&
         std::all_of(
             program.slots().begin(), program.slots().end(), [&](const reward::RewardSlot& slot) {
               return slot.asset.empty() ||
                      std::any_of(placed.begin(), placed.end(), [&](const AssetPlacement& one) {
                        return one.asset == slot.asset;
                      });
             });
}

bool TakesParameters(const reward::RewardProgram& program) {
  return std::any_of(
      program.slots().begin(), program.slots().end(),
      [](const reward::RewardSlot& slot) { return slot.input == reward::RewardInput::kParameter; });
}

// Returns the title that describes the joint's motion: the subtask's own text first.
std::string TitleOf(const Task& task, const Subtask& subtask) {
  const std::string own = subtask.name + " . " + subtask.description;
  if (DirectionOfTitle(own) != TitleDirection::kNone || task.subtasks.size() > 1) return own;
  return own + " . " + task.name + " . " + task.description;
}

}  // namespace

bool VerificationOptions::IsValid(std::string* error) const {
  const char* wrong = nullptr;
  if (!(against >= -1.0 && against <= unclear && unclear <= 1.0)) {
    wrong = "-1 <= against <= unclear <= 1 must hold";
  }
  if (random_states < 1) wrong = "random_states must be at least 1";
  if (wrong != nullptr && error != nullptr) *error = wrong;
  return wrong == nullptr;
}

SubtaskVerifier::SubtaskVerifier(const WorldModel& model, const VerificationOptions& options)
    : model_(model), options_(options) {
  std::string error;
  if (!options_.IsValid(&error)) throw core::Error(error, "verification");
}

std::optional<InitialState> SubtaskVerifier::PreviousEndState(
    const Task& task, const Subtask& subtask, const reward::RewardProgram& program) const {
  const auto self = std::find_if(task.subtasks.begin(), task.subtasks.end(),
                                 [&](const Subtask& s) { return s.name == subtask.name; });
  if (self == task.subtasks.begin() || self == task.subtasks.end()) return std::nullopt;
  const auto end = ends_.find({task.name, std::prev(self)->name});
  if (end == ends_.end()) return std::nullopt;
  if (!PlacesAllObjects(end->second, program)) return std::nullopt;
  return end->second;
}

core::Findings SubtaskVerifier::Verify(const Task& task, Subtask* subtask) {
  reward::RewardOptions compile_options;
  compile_options.entry = options_.entry;
  reward::CompileOutcome outcome =
      reward::CompileReward(subtask->program, &model_.names, compile_options);
  core::Findings findings = std::move(outcome.findings);
  PromoteToErrors(&findings);
  if (subtask->success.empty()) subtask->success = SuccessExpression(subtask->program);
  if (!outcome.program || HasError(findings)) return findings;
  if (TakesParameters(*outcome.program)) {
    if (options_.needs_success) {
      findings.push_back({"free-parameter", Severity::kError, "",
                          "the function takes parameters that nothing gives it: ask the "
                          "environment, compute_reward(env)",
                          0.0});
    }
    return findings;
  }
  const std::string title = TitleOf(task, *subtask);
  if (!PlacesAllObjects(subtask->start, *outcome.program)) {
    std::optional<InitialState> planned = PreviousEndState(task, *subtask, *outcome.program);
    if (!planned) {
      core::Rng rng = core::StreamRng(options_.seed, 0);
      planned = PlanStart(model_, outcome.program->slots(), task.assets, title,
                          DirectionOfTitle(title), rng);
    }
    if (!planned) {
      findings.push_back({"no-layout", Severity::kError, "",
                          "the things cannot be placed so that the robot reaches them", 0.0});
      return findings;
    }
    subtask->start = *planned;
  }
  if (ReadsGoal(*outcome.program) && !subtask->goal) {
    subtask->goal = PlanGoal(model_, StateOf(model_, subtask->start), outcome.program->slots());
  }
  Trial trial(model_, options_, *outcome.program, *subtask, title);
  const core::Findings seen = trial.Run();
  findings.insert(findings.end(), seen.begin(), seen.end());
  if (trial.path()) {
    ends_[{task.name, subtask->name}] = StartOfNextSubtask(
        model_, trial.path()->motion.states[trial.path()->first], subtask->start);
  }
  return findings;
}

}  // namespace simwright::tasks
