#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "nn/torch.h"
#include "rl/actor_critic.h"
#include "rl/flat_adam.h"
#include "rl/ppo_loss.h"
#include "rl/ppo_options.h"
#include "rl/rollout.h"
#include "rl/update_report.h"

namespace simwright::rl {

// The state that the next update depends on, except for the rollout. On the CPU.
struct LearnerState {
  torch::Tensor parameters, gradient_means, gradient_squares;  // (P)
  std::int64_t gradient_steps = 0;
  double learning_rate = 0.0;
  std::string generator;  // of core::Rng
  Demonstrations shown;   // so far, during imitation
};

// Updates actor and critic from rollouts.
class PpoLearner {
 public:
  PpoLearner(const ActorCriticSizes& sizes, const PpoOptions& options);

  // Runs `options.epochs` passes over the rollout in shuffled minibatches. With `critic_alone` the
  // actor does not learn.
  UpdateReport Update(const Rollout& rollout, bool critic_alone = false);

  const ActorCritic& networks() const { return networks_; }

  LearnerState SaveState() const;
  // Throws core::Error for a state of other sizes.
  void RestoreState(const LearnerState& state);

 private:
  torch::Tensor OnDevice(const Rows& rows) const;
  torch::Tensor OnDevice(const std::vector<float>& numbers) const;
  torch::Tensor Indices(const std::vector<std::int64_t>& rows) const;
  // Returns the values (n) of `observations` (n x O).
  std::vector<float> ValuesOf(const Rows& observations) const;
  Samples Evaluate(const Rollout& rollout) const;
  // Appends the demonstrations of the rollout at `rows` to the previous ones and fits the actor to
  // all of them. Clears them if the rollout has none.
  void Imitate(const Rollout& rollout, const Samples& samples,
               const std::vector<std::int64_t>& rows);
  // Samples from all demonstrations, with replacement.
  Demonstrations SampleDemonstrations();
  // Shuffles by Fisher and Yates.
  void Shuffle(std::vector<std::int64_t>* rows);
  // Adapts the learning rate after an epoch with mean KL divergence `kl`. Raises it only after the
  // `last` epoch: the first ones are always close to the old policy.
  void AdaptRate(double kl, bool last);
  // Returns the report of an update without a sample.
  UpdateReport NothingLearnt() const;
  // Steps against the parameters' gradients.
  void TakeGradientStep(UpdateReport* report);

  PpoOptions options_;
  torch::Device device_;
  core::Rng rng_;
  ActorCritic networks_;
  FlatAdam adam_;
  double learning_rate_;
  Demonstrations shown_;
};

}  // namespace simwright::rl
