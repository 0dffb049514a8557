#pragma once

#include <Eigen/Core>

#include "core/random.h"

namespace simwright::rl {

// Returns a matrix (rows x columns) whose shorter side's vectors are orthogonal, each of length
// `gain`, uniformly distributed (Saxe et al. 2014): the Q of a Gaussian matrix, R's diagonal
// positive.
Eigen::MatrixXd OrthogonalWeights(int rows, int columns, double gain, core::Rng& rng);

}  // namespace simwright::rl
