#pragma once

#include "nn/torch.h"
#include "rl/actor_critic.h"
#include "rl/ppo_options.h"

namespace simwright::rl {

// What B samples held when they were collected.
struct Samples {
  torch::Tensor observations;   // (B x O)
  torch::Tensor actions;        // (B x A)
  torch::Tensor means;          // (B x A)
  torch::Tensor log_densities;  // (B)
  torch::Tensor values;         // (B)
  torch::Tensor advantages;     // (B)
  torch::Tensor returns;        // (B)

  // The samples of `indices` (int64).
  Samples Select(const torch::Tensor& indices) const;
};

struct PpoLoss {
  torch::Tensor total;  // to descend on
  // Scalars without gradients.
  torch::Tensor policy, value, entropy;
  torch::Tensor kl;             // of the new policy from the old one, exact for Gaussians
  torch::Tensor clipped_share;  // of ratios outside the clip
};

// The clipped objective (Schulman et al. 2017, equations 7 and 9) on a minibatch, whose advantages
// are brought to mean 0 and standard deviation 1. `old_log_std` (A): of the policy that acted.
PpoLoss ComputePpoLoss(const ActorCritic& networks, const Samples& batch,
                       const torch::Tensor& old_log_std, const PpoOptions& options);

// What was shown at D observations.
struct Demonstrations {
  torch::Tensor observations;  // (D x O); not defined where nothing is shown
  torch::Tensor actions;       // (D x A)
};

// Half the squared distance between the actor's means and what was shown, in standard deviations:
// what a Gaussian of fixed width makes of maximum likelihood. Scalar.
torch::Tensor ComputeImitationLoss(const ActorCritic& networks, const Demonstrations& shown);

// What is left of ComputePpoLoss where the actor learns otherwise: the critic's part.
PpoLoss ComputeCriticLoss(const ActorCritic& networks, const Samples& batch,
                          const torch::Tensor& old_log_std, const PpoOptions& options);

}  // namespace simwright::rl
