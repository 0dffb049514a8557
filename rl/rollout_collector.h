#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "rl/mlp.h"
#include "rl/observation_normalizer.h"
#include "rl/ppo_options.h"
#include "rl/recent_outcomes.h"
#include "rl/reward_scaler.h"
#include "rl/rollout.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// All that a collector's next step depends on, but for the policy.
struct CollectorState {
  RunningMoments observations, returns;
  std::vector<double> discounted_returns;              // (N)
  std::vector<double> episode_rewards, episode_steps;  // (N) so far
  std::int64_t samples = 0, dropped = 0;
  std::string generator;    // core::Rng's
  std::string environment;  // VectorEnvironment::SaveState
};

// Acts in N environments and writes down what a learner needs.
class RolloutCollector {
 public:
  // `environment` must outlive the collector, and is reset.
  RolloutCollector(VectorEnvironment* environment, const PpoOptions& options);

  // Takes options.horizon steps with actions drawn about those of `actor`, and adds the episodes
  // that ended to `outcomes`. A step whose reward or observation is not finite is marked dropped,
  // and its episode forgotten. Throws core::Error, naming the seed, where more of them are than
  // options.largest_dropped_share allows.
  void Collect(const Mlp& actor, const Eigen::RowVectorXf& std, Rollout* rollout,
               std::vector<Outcome>* outcomes);

  const ObservationNormalizer& normalizer() const { return normalizer_; }
  std::int64_t samples() const { return samples_; }  // since the start, dropped ones included
  std::int64_t dropped() const { return dropped_; }

  CollectorState SaveState() const;
  // Throws core::Error for a state of other sizes.
  void RestoreState(const CollectorState& state);

 private:
  void Normalize(const Rows& observations, Rows* normalized) const;
  void TakeStep(int step, Rollout* rollout, std::vector<Outcome>* outcomes);
  // Adds the batch's rows that are not finite to those `dropped` (N), and counts them all.
  void FindDropped(std::vector<std::uint8_t>* dropped);
  void CheckDropped() const;
  void FollowEpisodes(const std::vector<std::uint8_t>& dropped, std::vector<Outcome>* outcomes);
  void KeepLastObservations(int step, Rollout* rollout) const;

  VectorEnvironment* environment_;
  PpoOptions options_;
  core::Rng rng_;
  ObservationNormalizer normalizer_;
  RewardScaler scaler_;
  StepBatch batch_;                                      // batch_.observations: what to act on next
  Rows actions_;                                         // (N x A)
  std::vector<double> episode_rewards_, episode_steps_;  // (N)
  std::int64_t samples_ = 0, dropped_ = 0;
};

}  // namespace simwright::rl
