#include "rl/rollout_collector.h"

#include <cmath>
#include <sstream>

#include "core/error.h"
#include "rl/gaussian_policy.h"
#include "rl/rank_streams.h"
#include "rl/shared_moments.h"

namespace simwright::rl {
namespace {

constexpr std::uint64_t kActionStream = 1;  // 0 is the networks' initial weights, 2 shuffles
constexpr std::uint64_t kEnvironmentStream = 3;

// Returns the seed of a rank's environments.
std::uint64_t EnvironmentSeed(std::uint64_t seed, int rank) {
  return rank == 0 ? seed : core::StreamRng(seed, StreamOfRank(kEnvironmentStream, rank))();
}

std::size_t CountOf(const VectorEnvironment& environment) {
  return static_cast<std::size_t>(environment.size());
}

std::vector<std::uint8_t> RowsNotFinite(const Rows& rows) {
  std::vector<std::uint8_t> found(static_cast<std::size_t>(rows.rows()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    found[static_cast<std::size_t>(i)] = !rows.row(i).allFinite();
  }
  return found;
}

}  // namespace

RolloutCollector::RolloutCollector(VectorEnvironment* environment, const PpoOptions& options,
                                   Communicator* ranks)
    : environment_(environment),
      options_(options),
      ranks_(ranks),
      environments_(static_cast<int>(ranks->Sum(environment->size()))),
      rng_(core::StreamRng(options.seed, StreamOfRank(kActionStream, ranks->rank()))),
      normalizer_(environment->observation_size()),
      scaler_(environment->size(), options.discount),
      episode_rewards_(CountOf(*environment), 0.0),
      episode_steps_(CountOf(*environment), 0.0),
      merged_observations_(environment->observation_size()) {
  environment_->Reset(EnvironmentSeed(options.seed, ranks->rank()), &batch_.observations);
}

void RolloutCollector::Normalize(const Rows& observations, Rows* normalized) const {
  if (options_.normalize_observations) {
    normalizer_.Apply(observations, normalized);
  } else {
    ObservationScale(static_cast<int>(observations.cols())).Apply(observations, normalized);
  }
}

void RolloutCollector::Collect(const Mlp& actor, const Eigen::RowVectorXf& std, Rollout* rollout,
                               std::vector<Outcome>* outcomes) {
  const int count = environment_->size();
  rollout->Resize(options_.horizon, count, environment_->observation_size(),
                  environment_->action_size());
  rollout->std = std;
  const bool imitates = samples_ < options_.imitated_samples;
  Rows normalized, means, shown;
  for (int step = 0; step < options_.horizon; ++step) {
    const Eigen::Index first = static_cast<Eigen::Index>(step) * count;
    normalizer_.Update(batch_.observations);
    Normalize(batch_.observations, &normalized);
    actor.Forward(normalized, &means);
    SampleActions(means, std, rng_, &actions_);
    rollout->observations.middleRows(first, count) = normalized;
    rollout->means.middleRows(first, count) = means;
    rollout->actions.middleRows(first, count) = actions_;
    Eigen::Map<Eigen::VectorXf>(rollout->log_densities.data() + first, count) =
        LogDensity(actions_, means, std);
    if (imitates && environment_->Demonstrate(&shown)) {
      rollout->shown.conservativeResize(rollout->actions.rows(), Eigen::NoChange);
      rollout->shown.middleRows(first, count) = shown;
    }
    TakeStep(step, rollout, outcomes);
  }
  Normalize(batch_.observations, &rollout->next_observations);
  MergeRanks();
  CheckDropped();
}

void RolloutCollector::MergeRanks() {
  if (ranks_->size() == 1) return;
  merged_observations_ = MergedOverRanks(merged_observations_, normalizer_.moments(), ranks_);
  normalizer_.Restore(merged_observations_);
  merged_returns_ = MergedOverRanks(merged_returns_, scaler_.moments(), ranks_);
  scaler_.Restore(merged_returns_, scaler_.discounted_returns());
  merged_dropped_ +=
      static_cast<std::int64_t>(ranks_->Sum(static_cast<double>(dropped_ - merged_dropped_)));
  dropped_ = merged_dropped_;
}

void RolloutCollector::TakeStep(int step, Rollout* rollout, std::vector<Outcome>* outcomes) {
  // Actions taken without a valid observation are as useless as the step that led there.
  std::vector<std::uint8_t> dropped = RowsNotFinite(batch_.observations);
  environment_->Step(actions_, &batch_);
  FindDropped(&dropped);
  FollowEpisodes(dropped, outcomes);
  KeepLastObservations(step, rollout);
  std::vector<float> rewards = batch_.rewards;
  if (options_.scale_rewards) {
    std::vector<std::uint8_t> ended = batch_.terminated;
    for (std::size_t i = 0; i < ended.size(); ++i) ended[i] |= batch_.truncated[i];
    scaler_.Scale(ended, dropped, &rewards);
  }
  const auto first = static_cast<std::ptrdiff_t>(step) * environment_->size();
  std::copy(rewards.begin(), rewards.end(), rollout->rewards.begin() + first);
  std::copy(batch_.terminated.begin(), batch_.terminated.end(),
            rollout->terminated.begin() + first);
  std::copy(batch_.truncated.begin(), batch_.truncated.end(), rollout->truncated.begin() + first);
  std::copy(dropped.begin(), dropped.end(), rollout->dropped.begin() + first);
}

void RolloutCollector::FindDropped(std::vector<std::uint8_t>* dropped) {
  const std::vector<std::uint8_t> next = RowsNotFinite(batch_.observations);
  for (std::size_t i = 0; i < next.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    (*dropped)[i] |= next[i] || !std::isfinite(batch_.rewards[i]) ||
                     (batch_.truncated[i] && !batch_.last_observations.row(row).allFinite());
    dropped_ += (*dropped)[i];
  }
  samples_ += environments_;
}

void RolloutCollector::CheckDropped() const {
  const double allowed = std::ceil(options_.largest_dropped_share * static_cast<double>(samples_));
  if (static_cast<double>(dropped_) <= allowed) return;
  throw core::Error(std::to_string(dropped_) + " of " + std::to_string(samples_) +
                        " samples have a non-finite number",
                    "training with seed " + std::to_string(options_.seed),
                    "check the world for instabilities and the reward for a division by 0");
}

void RolloutCollector::FollowEpisodes(const std::vector<std::uint8_t>& dropped,
                                      std::vector<Outcome>* outcomes) {
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    const bool ended = batch_.terminated[i] || batch_.truncated[i];
    if (!dropped[i]) {
      episode_rewards_[i] += batch_.rewards[i];
      episode_steps_[i] += 1.0;
      if (ended) {
        outcomes->push_back({episode_rewards_[i], episode_steps_[i], batch_.success[i] != 0});
      }
    }
    if (dropped[i] || ended) episode_rewards_[i] = episode_steps_[i] = 0.0;
  }
}

void RolloutCollector::KeepLastObservations(int step, Rollout* rollout) const {
  Rows kept(environment_->size(), environment_->observation_size());
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < batch_.truncated.size(); ++i) {
    if (!batch_.truncated[i] || batch_.terminated[i]) continue;
    kept.row(count++) = batch_.last_observations.row(static_cast<Eigen::Index>(i));
    rollout->last_rows.push_back(static_cast<std::size_t>(step) * CountOf(*environment_) + i);
  }
  if (count == 0) return;
  Rows normalized;
  Normalize(kept.topRows(count), &normalized);
  const Eigen::Index before = rollout->last_observations.rows();
  rollout->last_observations.conservativeResize(before + count, Eigen::NoChange);
  rollout->last_observations.bottomRows(count) = normalized;
}

CollectorState RolloutCollector::SaveState() const {
  std::ostringstream generator;
  generator << rng_;
  return {normalizer_.moments(),
          scaler_.moments(),
          scaler_.discounted_returns(),
          episode_rewards_,
          episode_steps_,
          samples_,
          dropped_,
          generator.str(),
          environment_->SaveState()};
}

void RolloutCollector::RestoreState(const CollectorState& state) {
  const std::size_t count = CountOf(*environment_);
  if (state.observations.mean.size() != environment_->observation_size() ||
      state.discounted_returns.size() != count || state.episode_rewards.size() != count ||
      state.episode_steps.size() != count) {
    throw core::Error("was written with another number of environments or observations");
  }
  std::istringstream generator(state.generator);
  if (!(generator >> rng_)) throw core::Error("holds no random generator");
  environment_->RestoreState(state.environment, &batch_.observations);
  normalizer_.Restore(state.observations);
  scaler_.Restore(state.returns, state.discounted_returns);
  episode_rewards_ = state.episode_rewards;
  episode_steps_ = state.episode_steps;
  samples_ = state.samples;
  dropped_ = merged_dropped_ = state.dropped;
  merged_observations_ = state.observations;
  merged_returns_ = state.returns;
}

}  // namespace simwright::rl
