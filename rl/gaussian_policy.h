#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// Samples actions from normal distributions with means `means` (n x A) and standard deviations
// `std` (A). They are not clamped: an environment clamps them itself, and their density is that of
// the unclamped sample. Consumes n A numbers of `rng`, row by row.
void SampleActions(const Rows& means, const Eigen::RowVectorXf& std, core::Rng& rng, Rows* actions);

// Returns the log density of each row of `actions` (n x A): (n).
Eigen::VectorXf LogDensity(const Rows& actions, const Rows& means, const Eigen::RowVectorXf& std);

}  // namespace simwright::rl
