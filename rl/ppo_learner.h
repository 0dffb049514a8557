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

// All that the next update depends on, but for the rollout. On the CPU.
struct LearnerState {
  torch::Tensor parameters, gradient_means, gradient_squares;  // (P)
  std::int64_t descents = 0;
  double learning_rate = 0.0;
  std::string generator;  // core::Rng's
  Demonstrations shown;   // so far, while they are imitated
};

// Improves actor and critic by what was collected.
class PpoLearner {
 public:
  PpoLearner(const ActorCriticSizes& sizes, const PpoOptions& options);

  // `options.epochs` passes over the rollout in shuffled minibatches. The actor learns unless
  // `critic_alone`.
  UpdateReport Update(const Rollout& rollout, bool critic_alone = false);

  const ActorCritic& networks() const { return networks_; }

  LearnerState SaveState() const;
  // Throws core::Error for a state of other sizes.
  void RestoreState(const LearnerState& state);

 private:
  torch::Tensor OnDevice(const Rows& rows) const;
  torch::Tensor OnDevice(const std::vector<float>& numbers) const;
  torch::Tensor Indices(const std::vector<std::int64_t>& rows) const;
  // Values (n) of `observations` (n x O).
  std::vector<float> ValuesOf(const Rows& observations) const;
  Samples Evaluate(const Rollout& rollout) const;
  // Adds what the rollout shows at `rows` to what was shown before, and brings the actor nearer to
  // all of it. Forgets it where nothing is shown.
  void Imitate(const Rollout& rollout, const Samples& samples,
               const std::vector<std::int64_t>& rows);
  // Some of all that was shown, with repetition.
  Demonstrations DrawShown();
  // Fisher and Yates.
  void Shuffle(std::vector<std::int64_t>* rows);
  // After an epoch of mean divergence `kl`. Up only after the `last` one: the first ones are always
  // close to the policy that acted.
  void AdaptRate(double kl, bool last);
  void Descend(const torch::Tensor& loss, UpdateReport* report);

  PpoOptions options_;
  torch::Device device_;
  core::Rng rng_;
  ActorCritic networks_;
  FlatAdam adam_;
  double learning_rate_;
  Demonstrations shown_;
};

}  // namespace simwright::rl
