#pragma once

namespace simwright::rl {

// The statistics of an update: means over its minibatches.
struct UpdateReport {
  double kl = 0.0;  // of the new policy from the old one; grows over the update
  double policy_loss = 0.0, value_loss = 0.0;
  double entropy = 0.0;             // of the action's distribution, nats
  double clipped_share = 0.0;       // of probability ratios outside the clip range
  double gradient_norm = 0.0;       // before it is clipped
  double learning_rate = 0.0;       // after the update
  double std = 0.0;                 // after the update, mean over actions
  double explained_variance = 0.0;  // share of the returns' variance that the critic explains
  int skipped = 0;                  // minibatches with a non-finite gradient
};

}  // namespace simwright::rl
