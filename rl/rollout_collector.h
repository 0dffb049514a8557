#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "rl/communicator.h"
#include "rl/mlp.h"
#include "rl/observation_normalizer.h"
#include "rl/ppo_options.h"
#include "rl/recent_outcomes.h"
#include "rl/reward_scaler.h"
#include "rl/rollout.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// The state that a collector's next step depends on, except for the policy.
struct CollectorState {
  RunningMoments observations, returns;
  std::vector<double> discounted_returns;              // (N)
  std::vector<double> episode_rewards, episode_steps;  // (N) so far
  std::int64_t samples = 0, dropped = 0;
  std::string generator;    // of core::Rng
  std::string environment;  // VectorEnvironment::SaveState
};

// Runs N environments and records their steps. With several ranks each runs its own environments
// with its own random streams; the moments of observations and returns are merged after each
// rollout, and samples are those of all ranks.
class RolloutCollector {
 public:
  // Resets `environment`, which must outlive the collector, as `ranks` must.
  RolloutCollector(VectorEnvironment* environment, const PpoOptions& options,
                   Communicator* ranks = SingleProcess());

  // Takes options.horizon steps with actions sampled from `actor` and `std`, and appends the
  // finished episodes to `outcomes`. A step with a non-finite reward or observation is marked as
  // dropped, and its episode is discarded. Throws core::Error, naming the seed, if the share of
  // such steps exceeds options.largest_dropped_share.
  void Collect(const Mlp& actor, const Eigen::RowVectorXf& std, Rollout* rollout,
               std::vector<Outcome>* outcomes);

  const ObservationNormalizer& normalizer() const { return normalizer_; }
  std::int64_t samples() const { return samples_; }  // since the start, including dropped ones
  std::int64_t dropped() const { return dropped_; }

  CollectorState SaveState() const;
  // Throws core::Error for a state of other sizes.
  void RestoreState(const CollectorState& state);

 private:
  void Normalize(const Rows& observations, Rows* normalized) const;
  void TakeStep(int step, Rollout* rollout, std::vector<Outcome>* outcomes);
  // Adds the rows of the batch that are not finite to `dropped` (N), and counts all dropped rows.
  void FindDropped(std::vector<std::uint8_t>* dropped);
  // Merges moments and counts of all ranks.
  void MergeRanks();
  void CheckDropped() const;
  void FollowEpisodes(const std::vector<std::uint8_t>& dropped, std::vector<Outcome>* outcomes);
  void KeepLastObservations(int step, Rollout* rollout) const;

  VectorEnvironment* environment_;
  PpoOptions options_;
  Communicator* ranks_;
  int environments_ = 0;  // of all ranks
  core::Rng rng_;
  ObservationNormalizer normalizer_;
  RewardScaler scaler_;
  StepBatch batch_;                                      // batch_.observations: the next inputs
  Rows actions_;                                         // (N x A)
  std::vector<double> episode_rewards_, episode_steps_;  // (N)
  std::int64_t samples_ = 0, dropped_ = 0;
  // At the last merging.
  RunningMoments merged_observations_, merged_returns_{1};
  std::int64_t merged_dropped_ = 0;
};

}  // namespace simwright::rl
