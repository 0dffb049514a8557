#pragma once

#include "nn/torch.h"
#include "rl/actor_critic.h"
#include "rl/ppo_options.h"

namespace simwright::rl {

// The mean and the standard deviation of a minibatch's advantages.
struct AdvantageScale {
  double mean = 0.0, deviation = 1.0;
};

// B samples of a rollout, with the values at collection time.
struct Samples {
  torch::Tensor observations;   // (B x O)
  torch::Tensor actions;        // (B x A)
  torch::Tensor means;          // (B x A)
  torch::Tensor log_densities;  // (B)
  torch::Tensor values;         // (B)
  torch::Tensor advantages;     // (B)
  torch::Tensor returns;        // (B)

  // Returns the samples at `indices` (int64).
  Samples Select(const torch::Tensor& indices) const;
  // Returns samples [first, first + count), which share their memory with these.
  Samples Rows(std::int64_t first, std::int64_t count) const;
  // Shifts and scales the advantages to mean 0 and standard deviation 1. `scale`: of the whole
  // minibatch where these are a part of it; null: their own.
  void NormalizeAdvantages(const AdvantageScale* scale = nullptr);
};

struct PpoLoss {
  torch::Tensor total;  // to minimize
  // Scalars without gradients.
  torch::Tensor policy, value, entropy;
  torch::Tensor kl;             // of the new policy from the old one, exact for Gaussians
  torch::Tensor clipped_share;  // of ratios outside the clip range
};

// Computes the clipped objective (Schulman et al. 2017, equations 7 and 9), the mean over rows of a
// minibatch whose advantages are normalized. `old_log_std` (A): of the policy that acted.
PpoLoss ComputePpoLoss(const ActorCritic& networks, const Samples& batch,
                       const torch::Tensor& old_log_std, const PpoOptions& options);

// Demonstrated actions at D observations.
struct Demonstrations {
  torch::Tensor observations;  // (D x O); undefined without demonstrations
  torch::Tensor actions;       // (D x A)
};

// Computes half the squared distance between the actor's means and the demonstrated actions, in
// standard deviations: the negative log likelihood of a Gaussian of fixed width, up to a constant.
// Only `total` is defined.
PpoLoss ComputeImitationLoss(const ActorCritic& networks, const Demonstrations& shown);

// Computes the critic's part of ComputePpoLoss, for phases in which the actor does not learn by
// PPO.
PpoLoss ComputeCriticLoss(const ActorCritic& networks, const Samples& batch,
                          const torch::Tensor& old_log_std, const PpoOptions& options);

}  // namespace simwright::rl
