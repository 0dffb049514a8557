#include "rl/policy.h"

#include "core/error.h"

namespace simwright::rl {

Policy::Policy(const ObservationScale& scale, const Mlp& actor, const Eigen::RowVectorXf& std,
               const Metadata& metadata)
    : scale_(scale), actor_(actor), std_(std), metadata_(metadata) {
  if (scale.mean().size() != actor.input_size() || scale.factor().size() != actor.input_size() ||
      std.size() != actor.output_size()) {
    throw core::Error("its sizes do not match", "policy");
  }
}

void Policy::Act(const Rows& observations, Rows* actions) const {
  Rows scaled;
  scale_.Apply(observations, &scaled);
  actor_.Forward(scaled, actions);
  *actions = actions->array().max(-1.0f).min(1.0f);
}

}  // namespace simwright::rl
