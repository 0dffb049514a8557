#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// Actions drawn from normal distributions about `means` (n x A) with standard deviations `std` (A).
// They are not clamped: an environment clamps them itself, and their probability is that of the
// draw. Draws n A numbers from `rng`, row by row.
void DrawActions(const Rows& means, const Eigen::RowVectorXf& std, core::Rng& rng, Rows* actions);

// log of the density of each row of `actions` (n x A): (n).
Eigen::VectorXf LogDensity(const Rows& actions, const Rows& means, const Eigen::RowVectorXf& std);

}  // namespace simwright::rl
