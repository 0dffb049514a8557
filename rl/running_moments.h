#pragma once

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// Mean and variance of all rows seen so far, a column at a time, in double precision.
struct RunningMoments {
  explicit RunningMoments(int size = 0);

  // Merges a batch (Chan, Golub and LeVeque 1983). A row that holds a number that is not finite is
  // left out.
  void Add(const Rows& rows);
  // Of the population; 1 before anything was seen.
  Eigen::ArrayXd Variance() const;

  double count = 0.0;
  Eigen::ArrayXd mean;
  Eigen::ArrayXd squares;  // sum of squared distances from the mean
};

}  // namespace simwright::rl
