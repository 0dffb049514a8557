#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "nn/torch.h"
#include "rl/actor_critic.h"
#include "rl/communicator.h"
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

// The minibatches of an update, of which each rank has a share of the rows.
struct MinibatchShares {
  std::int64_t rows = 0;        // of this rank
  std::int64_t parts = 1;       // minibatches
  std::vector<double> weights;  // (parts) this rank's rows over all ranks' rows of a minibatch

  std::int64_t first(std::int64_t part) const { return rows * part / parts; }
};

// Updates actor and critic from rollouts. With several ranks each learns from its own rollout: the
// gradient of a minibatch is the mean over the rows of all ranks, so that N ranks with E / N
// environments learn as one process with E environments does.
class PpoLearner {
 public:
  // `ranks` must outlive this.
  PpoLearner(const ActorCriticSizes& sizes, const PpoOptions& options,
             Communicator* ranks = SingleProcess());

  // Runs `options.epochs` passes over the rollout in shuffled minibatches. With `critic_alone` the
  // actor does not learn. All ranks call it together. Throws core::Error, on all ranks, if their
  // policies have come to differ.
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
  // Returns the minibatches of `rows` rows of this rank and `all` of all ranks.
  MinibatchShares SharesOf(std::int64_t rows, std::int64_t all) const;
  // Returns the scale of each minibatch's advantages (this rank's, in minibatch order) over all
  // ranks; empty for one rank.
  std::vector<AdvantageScale> ScalesOf(const torch::Tensor& advantages,
                                       const MinibatchShares& shares) const;
  // Takes a gradient step for each minibatch of the rows in this order. Returns the mean KL
  // divergence.
  double LearnEpoch(const Samples& samples, const std::vector<std::int64_t>& rows,
                    const MinibatchShares& shares, const torch::Tensor& old_log_std, bool by_ppo,
                    UpdateReport* report);
  void RequireEqualPolicies() const;
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
  // Steps against the sum of all ranks' gradients, each times its rank's `weight`; of one rank, the
  // weight is 1.
  void TakeGradientStep(double weight, UpdateReport* report);
  void SumOverRanks(torch::Tensor* gradients) const;

  PpoOptions options_;
  Communicator* ranks_;
  torch::Device device_;
  core::Rng rng_;
  ActorCritic networks_;
  FlatAdam adam_;
  double learning_rate_;
  Demonstrations shown_;
  std::int64_t updates_ = 0;
};

}  // namespace simwright::rl
