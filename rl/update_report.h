#pragma once

namespace simwright::rl {

// What an update came to: means over its minibatches.
struct UpdateReport {
  double kl = 0.0;  // of the policy from the one that acted; grows over the update
  double policy_loss = 0.0, value_loss = 0.0;
  double entropy = 0.0;             // of the action's distribution, nats
  double clipped_share = 0.0;       // of ratios of new to old probability
  double gradient_norm = 0.0;       // before it is shortened
  double learning_rate = 0.0;       // after the update
  double std = 0.0;                 // after the update, mean over actions
  double explained_variance = 0.0;  // share of the returns' variance that the critic foresaw
  int skipped = 0;                  // minibatches whose gradient was not finite
};

}  // namespace simwright::rl
