#include "rl/training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/log.h"
#include "core/progress.h"
#include "rl/communicator.h"
#include "rl/policy_file.h"
#include "rl/ppo.h"
#include "rl/training_checkpoint.h"
#include "rl/training_curves.h"
#include "rl/training_log.h"
#include "rl/wilson_interval.h"

namespace simwright::rl {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const TrainingOptions& CheckedRequest(const TrainingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "training options");
  return options;
}

// Creates the folder. Returns true if there is a checkpoint to resume from.
bool Prepare(const std::filesystem::path& folder, bool resume) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) {
    throw core::Error("cannot create the folder: " + code.message(), folder.string(),
                      "check that its parent exists and is writable");
  }
  const bool found = std::filesystem::exists(folder / kCheckpointFile);
  if (found && !resume) {
    throw core::Error("already holds a training", folder.string(),
                      "resume it with --resume, or choose another folder");
  }
  return found;
}

// Returns the outcomes of all ranks, by rank.
std::vector<Outcome> OutcomesOfAll(const std::vector<Outcome>& own, Communicator* ranks) {
  if (ranks->size() == 1) return own;
  std::vector<double> numbers;
  for (const Outcome& outcome : own) {
    numbers.insert(numbers.end(),
                   {outcome.total_reward, outcome.steps, outcome.success ? 1.0 : 0.0});
  }
  std::vector<Outcome> all;
  for (const std::string& bytes : ranks->AllGather(
           {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)})) {
    if (bytes.empty()) continue;
    numbers.resize(bytes.size() / sizeof(double));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      all.push_back({numbers[i], numbers[i + 1], numbers[i + 2] != 0.0});
    }
  }
  return all;
}

// A training and the files of its folder, which rank 0 writes.
class Training {
 public:
  Training(VectorEnvironment* environment, const TrainingOptions& options,
           const std::filesystem::path& folder, bool resume, const Examiner& examine,
           Communicator* ranks)
      : options_(CheckedRequest(options)),
        folder_(folder),
        examine_(examine),
        ranks_(ranks),
        ppo_(environment, options.ppo, ranks),
        recent_(options.success_window) {
    if (resume) {
      progress_ = ReadCheckpoint(folder / kCheckpointFile, options.metadata, &ppo_, &recent_);
    } else if (!options.begin_from.empty()) {
      BeginFromCheckpoint(options.begin_from, &ppo_);
    }
    if (ranks_->leads()) log_.emplace(folder, progress_.iteration);
  }

  // Collects, learns, examines if due, and appends to the log.
  TrainingRecord Iterate();
  // Returns why the training has ended, if it has.
  std::optional<TrainingEnd> End() const;
  bool SaveDue() const { return progress_.iteration % options_.checkpoint_every == 0; }
  void Save() const;
  TrainingRecord LastRecord() const {
    return !log_ || log_->records().empty() ? TrainingRecord() : log_->records().back();
  }

 private:
  TrainingRecord RecordOf(const UpdateReport& update) const;
  bool BudgetSpent() const { return BudgetEnd().has_value(); }
  std::optional<TrainingEnd> BudgetEnd() const;
  bool ExaminationDue() const;
  // Adds the time of rank 0, which decides for all ranks when they end.
  void AddSeconds(double seconds) {
    progress_.seconds += ranks_->Sum(ranks_->leads() ? seconds : 0.0);
  }
  // Returns the success rate; writes the policy if it is the best so far.
  double Examine();
  Policy CurrentPolicy() const {
    const Policy policy = ppo_.CurrentPolicy();
    return Policy(policy.scale(), policy.actor(), policy.std(), options_.metadata);
  }

  TrainingOptions options_;
  std::filesystem::path folder_;
  Examiner examine_;
  Communicator* ranks_;
  Ppo ppo_;
  OutcomeWindow recent_;
  TrainingProgress progress_;
  std::optional<TrainingLog> log_;
};

TrainingRecord Training::Iterate() {
  const Clock::time_point start = Clock::now();
  const std::int64_t samples = ppo_.samples();
  std::vector<Outcome> outcomes;
  ppo_.Collect(&outcomes);
  outcomes = OutcomesOfAll(outcomes, ranks_);
  const double collected = SecondsSince(start);
  const UpdateReport update = ppo_.Update();
  const double seconds = SecondsSince(start);
  for (const Outcome& outcome : outcomes) recent_.Add(outcome);
  ++progress_.iteration;
  progress_.episodes += static_cast<std::int64_t>(outcomes.size());
  AddSeconds(seconds);
  TrainingRecord record = RecordOf(update);
  record.examined = ExaminationDue() ? Examine() : std::nan("");
  AddSeconds(SecondsSince(start) - seconds);
  record.samples_per_second = static_cast<double>(ppo_.samples() - samples) / seconds;
  record.learner_share = (seconds - collected) / seconds;
  if (!log_) return record;
  log_->Append(record);
  core::Log(core::LogLevel::kInfo, "rl", "iteration ", progress_.iteration, ": ", ppo_.samples(),
            " samples, success ", record.success, ", return ", record.mean_return);
  return record;
}

TrainingRecord Training::RecordOf(const UpdateReport& update) const {
  TrainingRecord record;
  record.iteration = static_cast<double>(progress_.iteration);
  record.samples = static_cast<double>(ppo_.samples());
  record.seconds = progress_.seconds;
  record.episodes = static_cast<double>(progress_.episodes);
  record.mean_return = recent_.MeanReward();
  record.mean_steps = recent_.MeanSteps();
  record.success = recent_.SuccessRate();
  const Interval interval = recent_.SuccessInterval();
  record.success_low = interval.low;
  record.success_high = interval.high;
  record.kl = update.kl;
  record.learning_rate = update.learning_rate;
  record.policy_loss = update.policy_loss;
  record.value_loss = update.value_loss;
  record.entropy = update.entropy;
  record.std = update.std;
  record.clipped_share = update.clipped_share;
  record.gradient_norm = update.gradient_norm;
  record.explained_variance = update.explained_variance;
  record.dropped = static_cast<double>(ppo_.dropped());
  return record;
}

bool Training::ExaminationDue() const {
  if (!examine_) return false;
  if (BudgetSpent()) return true;
  if (options_.examine_from == 0.0 && progress_.iteration == 1) return true;
  return progress_.iteration % options_.examine_every == 0 && recent_.full() &&
         recent_.SuccessRate() >= options_.examine_from;
}

double Training::Examine() {
  const Policy policy = CurrentPolicy();
  Examination found = examine_(policy);
  found.successes = static_cast<int>(ranks_->Sum(found.successes));
  found.episodes = static_cast<int>(ranks_->Sum(found.episodes));
  const double rate = static_cast<double>(found.successes) / std::max(1, found.episodes);
  if (rate >= progress_.best) {
    progress_.best = rate;
    if (ranks_->leads()) WritePolicy(policy, folder_ / kPolicyFile);
  }
  progress_.learnt = options_.success_target > 0.0 &&
                     WilsonInterval(found.successes, found.episodes).low >= options_.success_target;
  return rate;
}

std::optional<TrainingEnd> Training::End() const {
  const bool learnt = examine_ ? progress_.learnt
                               : options_.success_target > 0.0 && recent_.full() &&
                                     recent_.SuccessInterval().low >= options_.success_target;
  return learnt ? TrainingEnd::kSuccess : BudgetEnd();
}

std::optional<TrainingEnd> Training::BudgetEnd() const {
  if (ppo_.samples() >= options_.max_samples) return TrainingEnd::kSamples;
  if (options_.max_seconds > 0.0 && progress_.seconds >= options_.max_seconds) {
    return TrainingEnd::kSeconds;
  }
  return std::nullopt;
}

void Training::Save() const {
  WriteCheckpoint(ppo_, progress_, recent_, options_.metadata, folder_ / kCheckpointFile);
  if (!log_) return;
  if (progress_.best < 0.0) WritePolicy(CurrentPolicy(), folder_ / kPolicyFile);
  core::WriteFile(folder_ / kCurvesFile, TrainingCurves(options_.title, log_->records()));
}

}  // namespace

TrainingResult TrainPolicy(VectorEnvironment* environment, const TrainingOptions& options,
                           const std::filesystem::path& folder, bool resume,
                           const TrainingListener& report, const Examiner& examine,
                           Communicator* ranks) {
  if (ranks == nullptr) ranks = SingleProcess();
  CheckedRequest(options);
  const bool found = ranks->leads() && Prepare(folder, resume);
  Training training(environment, options, folder, ranks->Sum(found ? 1.0 : 0.0) > 0.0, examine,
                    ranks);
  std::optional<TrainingEnd> end = training.End();
  while (!end) {
    const TrainingRecord record = training.Iterate();
    end = training.End();
    if (report) report(record);
    // Read once: it may change at any time, and on each rank at another.
    const bool cancelled = ranks->Sum(core::CancelRequested() ? 1.0 : 0.0) > 0.0;
    if (end || cancelled || training.SaveDue()) training.Save();
    if (cancelled) throw core::Cancelled();
  }
  return {*end, training.LastRecord()};
}

}  // namespace simwright::rl
