#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rl/activation.h"

namespace simwright::rl {

// Proximal policy optimisation (Schulman et al. 2017). "Study": Andrychowicz et al. 2021, "What
// Matters for On-Policy Deep Actor-Critic Methods?".
struct PpoOptions {
  // The layer sizes of the actor and of the critic each. Sizes decrease: the first layer mixes the
  // observations, the last one selects. On two cores larger layers cost more than the physics.
  std::vector<int> hidden = {256, 128, 64};
  Activation activation = Activation::kElu;

  // Actions lie in [-1, 1]: at 0.6 one sample in ten is clamped at the start, and both ends are
  // reached.
  double initial_std = 0.6;
  // Below the smallest standard deviation the policy's KL divergence reacts to rounding; above the
  // largest nearly all actions are clamped, and the entropy bonus could grow without bound.
  double smallest_std = 0.02;
  double largest_std = 1.5;

  // A horizon of 100 steps: 5 s of control at 20 Hz, 1.7 s at 60 Hz, the duration of a subtask.
  double discount = 0.99;
  // The study's value and the paper's: 20 steps of rewards before the critic is trusted.
  double lambda = 0.95;

  // The steps of each environment between updates. 64 environments then give 4096 samples, and most
  // advantages see their 20 steps before the critic's estimate ends the sequence.
  int horizon = 64;
  // The passes over each sample. Physics costs more than learning here, hence more than the 3 to 5
  // of GPU simulators; the learning rate is lowered where 8 are too many.
  int epochs = 8;
  // The samples per gradient step. Smaller minibatches take more steps from the same samples,
  // larger ones use the matrix products better; below 512 the time per sample rises.
  int minibatch = 1024;

  // The number of initial samples from which only the critic learns. Where an action of zero is
  // already good, an untrained critic would lead the policy away from it.
  std::int64_t critic_samples = 0;
  // The number of initial samples from which the actor learns the actions of
  // VectorEnvironment::Demonstrate at the states that it reaches by itself (DAgger, Ross et al.
  // 2011), and the critic the value of the actor's own actions. Without demonstrations, and after
  // that, both learn by PPO.
  std::int64_t imitated_samples = 0;
  // The gradient steps on all demonstrations after each `horizon`. Demonstrated actions are
  // discontinuous, for instance where fingers close, so that few steps fit them badly.
  int imitation_steps = 200;

  // The clip range of the ratio of new to old probability (the paper's).
  double clip = 0.2;
  // The clip range of the critic around its old value, in values; 0: no clipping. Clipping did not
  // help in the study.
  double value_clip = 0.0;
  // The weight of the critic's loss. Actor and critic share no layer, so this only affects the
  // gradient norm.
  double value_weight = 1.0;
  // The weight of the entropy bonus. 0: with dense rewards a bonus only slows the decay of the
  // learned standard deviation.
  double entropy_weight = 0.0;
  // The gradient norm limit (the study's); bounds the effect of a rare bad minibatch.
  double gradient_norm = 0.5;

  // The initial learning rate. It is divided by 1.5 after an epoch whose KL divergence from the old
  // policy exceeds twice `target_kl`, and multiplied by 1.5 after an update whose last epoch is
  // below half of it. Adapting after each minibatch (Rudin et al. 2022) makes the rate oscillate:
  // the first ones of an update are always close to the old policy, the last far from it.
  double learning_rate = 1e-3;
  double target_kl = 0.01;  // 0: the rate is constant
  // The bounds of the rate: at the lower one learning stops, above the upper one Adam's steps undo
  // orthogonal weights within an iteration.
  double smallest_rate = 1e-5;
  double largest_rate = 3e-3;
  // Adam's own 1e-8 lets parameters with small gradients jump.
  double adam_epsilon = 1e-5;

  // Both on: a network learns inputs and targets of size 1, independent of the units of the world.
  bool normalize_observations = true;
  bool scale_rewards = true;

  // The largest share of samples with a non-finite number; one is always allowed. Such samples are
  // excluded from learning; more of them mean a broken world.
  double largest_dropped_share = 1e-5;

  // Learns on CUDA if available. Off: below about 512-512-512 the copies cost more.
  bool cuda = false;
  std::uint64_t seed = 1;

  // Returns false, with the reason, for invalid values.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::rl
