#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rl/activation.h"

namespace simwright::rl {

// Proximal policy optimisation (Schulman et al. 2017). "Study": Andrychowicz et al. 2021, "What
// Matters for On-Policy Deep Actor-Critic Methods?".
struct PpoOptions {
  // Of the actor and of the critic each. Falling sizes: the first layer mixes what is observed, the
  // last only chooses. On two cores larger ones cost more than the physics.
  std::vector<int> hidden = {256, 128, 64};
  Activation activation = Activation::kElu;

  // Actions lie in [-1, 1]: at 0.6 one draw in ten is clamped at the start, and both ends are met.
  double initial_std = 0.6;
  // Below the first the policy's KL divergence reacts to rounding; above the second nearly all
  // actions are clamped, and the entropy bonus could grow without end.
  double smallest_std = 0.02;
  double largest_std = 1.5;

  // 100 steps ahead: 5 s of control at 20 Hz, 1.7 s at 60 Hz, the time that a subtask takes.
  double discount = 0.99;
  // The study's and everyone's since the paper: 20 steps of rewards before the critic is believed.
  double lambda = 0.95;

  // Steps of each environment between updates. 64 environments then give 4096 samples, and most
  // advantages see their 20 steps before the critic's guess ends the sequence.
  int horizon = 64;
  // Times that each sample is learnt from. Physics costs more than learning here, so more than the
  // 3 to 5 of GPU simulators; the learning rate holds the policy back where 8 are too many.
  int epochs = 8;
  // Samples a gradient step. Smaller ones take more steps from the same samples, larger ones keep
  // the matrix products busy; below 512 the time a sample rises.
  int minibatch = 1024;

  // Samples at the beginning from which only the critic learns. Where an action of zero is good
  // already, a critic that knows nothing leads away from it: picking an apple with a guided hand,
  // the rate of its episodes fell from 80 to 66 % in 57k samples without.
  std::int64_t critic_samples = 0;
  // Samples at the beginning from which the actor learns what VectorEnvironment::Demonstrate shows
  // at each state that it gets to by itself (DAgger, Ross et al. 2011), and the critic what its own
  // actions are worth. Where nothing is shown, and after that, both learn by PPO.
  std::int64_t imitated_samples = 0;
  // Gradient steps on what was shown so far, after each `horizon`. What is shown jumps, as where
  // fingers close: with 20, an actor succeeded in 28 % of the episodes where the script that it was
  // shown does in 67 % (opening microwaves).
  int imitation_steps = 200;

  // Of the ratio of new to old probability (the paper's).
  double clip = 0.2;
  // How far the critic may move from its old value, in values; 0: anywhere. Clipping it helped
  // nowhere in the study.
  double value_clip = 0.0;
  // Actor and critic share no layer, so that this only weighs the critic in the gradient's norm.
  double value_weight = 1.0;
  // 0: the standard deviation is learnt, and where rewards are dense a bonus only slows its fall.
  double entropy_weight = 0.0;
  // Longest gradient (the study's); a rare bad minibatch does no harm.
  double gradient_norm = 0.5;

  // To begin with. Then divided by 1.5 after an epoch whose KL divergence from the old policy is
  // over twice `target_kl`, and times 1.5 after an update whose last epoch's is below half. Judged
  // by single minibatches (Rudin et al. 2022) the rate swings: the first of an update are always
  // close to the old policy, the last far from it.
  double learning_rate = 1e-3;
  double target_kl = 0.01;  // 0: the rate stays
  // Bounds of the rate: at the lower one learning stands still, above the upper one Adam's steps
  // undo orthogonal weights within an iteration.
  double smallest_rate = 1e-5;
  double largest_rate = 3e-3;
  // 1e-8, Adam's own, lets parameters with small gradients jump.
  double adam_epsilon = 1e-5;

  // Both on: a network learns inputs and targets of size 1, whatever units the world is in.
  bool normalize_observations = true;
  bool scale_rewards = true;

  // Share of samples that may hold a number that is not finite, one being always allowed. They are
  // not learnt from; more of them mean a broken world.
  double largest_dropped_share = 1e-5;

  // Learns on CUDA where it is there. Off: below about 512-512-512 the copies cost more.
  bool cuda = false;
  std::uint64_t seed = 1;

  // False, with the reason, for values that no training can have.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::rl
