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
  std::vector<int> hidden;  // of each of the two networks
  Activation activation = Activation::kElu;
  bool operator==(const ActorCriticSizes&) const = default;
};

// The networks that PPO learns: the mean of a Gaussian over actions, its standard deviation, which
// is the same for all observations, and, apart from them, the value of an observation.
class ActorCritic {
 public:
  // Weights are orthogonal, scaled by sqrt 2, the last of the actor by 0.01 (it starts out about
  // the middle of all actions) and of the critic by 1 (Engstrom et al. 2020; Andrychowicz et al.
  // 2021); biases 0; standard deviations `initial_std`.
  ActorCritic(const ActorCriticSizes& sizes, double initial_std, core::Rng& rng,
              torch::Device device);

  torch::Tensor Means(const torch::Tensor& observations) const;    // (B x O) to (B x A)
  torch::Tensor Values(const torch::Tensor& observations) const;   // (B x O) to (B)
  const torch::Tensor& log_std() const { return parameters_[0]; }  // (A)

  // The actor as it is now.
  Mlp Actor() const;
  Eigen::RowVectorXf Std() const;  // (A)
  // Keeps the standard deviations in [low, high].
  void ClampStd(double low, double high);

  const ActorCriticSizes& sizes() const { return sizes_; }
  const FlatParameters& parameters() const { return parameters_; }

 private:
  // A network's layers begin at `first`: weights (outputs x inputs) and bias of each.
  torch::Tensor Forward(std::size_t first, const torch::Tensor& observations) const;

  ActorCriticSizes sizes_;
  FlatParameters parameters_;  // log_std, the actor's layers, the critic's
};

}  // namespace simwright::rl
