#pragma once

#include <memory>
#include <vector>

#include "rl/policy.h"
#include "rl/ppo_options.h"
#include "rl/recent_outcomes.h"
#include "rl/rollout_collector.h"
#include "rl/update_report.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

struct LearnerState;

// Proximal policy optimisation: acts in an environment, learns from what came of it. Everything is
// drawn from options.seed: the same seed, machine and number of threads give the same policy, bit
// for bit.
class Ppo {
 public:
  // `environment` must outlive this, and is reset. Gives libtorch core::ThreadCount() threads.
  // Throws core::Error for options that are not valid, or an environment without size.
  Ppo(VectorEnvironment* environment, const PpoOptions& options);
  ~Ppo();
  Ppo(const Ppo&) = delete;
  Ppo& operator=(const Ppo&) = delete;

  // options.horizon steps of each environment; the episodes that ended are added to `outcomes`.
  // Throws core::Error as RolloutCollector does.
  void Collect(std::vector<Outcome>* outcomes);
  // Learns from what Collect gave.
  UpdateReport Update();

  // What has been learnt, to act on its own.
  Policy CurrentPolicy() const;
  const PpoOptions& options() const { return options_; }
  std::int64_t samples() const { return collector_.samples(); }
  std::int64_t dropped() const { return collector_.dropped(); }

  // For training_checkpoint.
  CollectorState CollectorPart() const { return collector_.SaveState(); }
  LearnerState LearnerPart() const;
  // Throws core::Error for a state of other sizes.
  void Restore(const CollectorState& collector, const LearnerState& learner);

 private:
  struct Learner;
  PpoOptions options_;
  RolloutCollector collector_;
  std::unique_ptr<Learner> learner_;
  Rollout rollout_;
};

}  // namespace simwright::rl
