#pragma once

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// The running mean and variance of the columns of all rows, in double precision.
struct RunningMoments {
  explicit RunningMoments(int size = 0);

  // Merges a batch (Chan, Golub and LeVeque 1983). Rows with a non-finite number are left out.
  void Add(const Rows& rows);
  // Returns the population variance; 1 before the first row.
  Eigen::ArrayXd Variance() const;

  double count = 0.0;
  Eigen::ArrayXd mean;
  Eigen::ArrayXd squares;  // sum of squared distances from the mean
};

}  // namespace simwright::rl
