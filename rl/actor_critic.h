#pragma once

#include <vector>

#include "core/random.h"
#include "nn/torch.h"
#include "rl/activation.h"
#include "rl/flat_parameters.h"
#include "rl/mlp.h"

namespace simwright::rl {

struct ActorCriticSizes {
  int observations = 0;     // O
  int actions = 0;          // A
  std::vector<int> hidden;  // of each network
  Activation activation = Activation::kElu;
  bool operator==(const ActorCriticSizes&) const = default;
};

// The networks that PPO trains: the mean of a Gaussian over actions, its state-independent standard
// deviation, and a separate network for the value of an observation.
class ActorCritic {
 public:
  // Initializes weights orthogonally with gain sqrt 2, except for the last layer: gain 0.01 for the
  // actor, so that actions start near the middle of their range, and 1 for the critic (Engstrom et
  // al. 2020; Andrychowicz et al. 2021). Biases are 0, standard deviations `initial_std`.
  ActorCritic(const ActorCriticSizes& sizes, double initial_std, core::Rng& rng,
              torch::Device device);

  torch::Tensor Means(const torch::Tensor& observations) const;    // (B x O) to (B x A)
  torch::Tensor Values(const torch::Tensor& observations) const;   // (B x O) to (B)
  const torch::Tensor& log_std() const { return parameters_[0]; }  // (A)

  // Returns a copy of the actor with its current weights.
  Mlp Actor() const;
  Eigen::RowVectorXf Std() const;  // (A)
  // Clamps the standard deviations to [low, high].
  void ClampStd(double low, double high);

  const ActorCriticSizes& sizes() const { return sizes_; }
  const FlatParameters& parameters() const { return parameters_; }

 private:
  // Runs the network whose layers begin at parameter `first`: weights (outputs x inputs) and bias
  // of each layer.
  torch::Tensor Forward(std::size_t first, const torch::Tensor& observations) const;

  ActorCriticSizes sizes_;
  FlatParameters parameters_;  // log_std, then the layers of the actor, then of the critic
};

}  // namespace simwright::rl
