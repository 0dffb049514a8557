#pragma once

#include <memory>
#include <vector>

#include "rl/communicator.h"
#include "rl/policy.h"
#include "rl/ppo_options.h"
#include "rl/recent_outcomes.h"
#include "rl/rollout_collector.h"
#include "rl/update_report.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

struct LearnerState;

// Proximal policy optimization: collects rollouts in an environment and learns from them. All
// random numbers derive from options.seed: the same seed and machine give bit-identical policies,
// for any number of threads. With several ranks, which all call the same members, each steps its
// own environment, and all have the same policy.
class Ppo {
 public:
  // Resets `environment`, which must outlive this, and calls nn::PrepareForWork. `ranks` must
  // outlive this. Throws core::Error for invalid options and for an environment without size.
  Ppo(VectorEnvironment* environment, const PpoOptions& options,
      Communicator* ranks = SingleProcess());
  ~Ppo();
  Ppo(const Ppo&) = delete;
  Ppo& operator=(const Ppo&) = delete;

  // Runs options.horizon steps of each environment and appends the finished episodes to `outcomes`.
  // Throws core::Error as RolloutCollector does.
  void Collect(std::vector<Outcome>* outcomes);
  // Learns from the last rollout.
  UpdateReport Update();

  // Returns a frozen copy of the current policy.
  Policy CurrentPolicy() const;
  const PpoOptions& options() const { return options_; }
  Communicator& ranks() const { return *ranks_; }
  std::int64_t samples() const { return collector_.samples(); }
  std::int64_t dropped() const { return collector_.dropped(); }

  // The state for training_checkpoint.
  CollectorState CollectorPart() const { return collector_.SaveState(); }
  LearnerState LearnerPart() const;
  // Throws core::Error for a state of other sizes.
  void Restore(const CollectorState& collector, const LearnerState& learner);

 private:
  struct Learner;
  PpoOptions options_;
  Communicator* ranks_;
  RolloutCollector collector_;
  std::unique_ptr<Learner> learner_;
  Rollout rollout_;
};

}  // namespace simwright::rl
