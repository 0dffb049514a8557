#pragma once

#include <vector>

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// The initiation set of a skill: the states from which it succeeds, estimated from sampled start
// states by logistic regression on what its policy observes there. (Lee et al., CoRL 2021, classify
// them by a network.)
class InitiationSet {
 public:
  // `observations` (n x O) with outcomes `succeeded` (n). `ridge` > 0 regularizes the weights.
  // Throws core::Error if there are no start states, or if the lengths differ.
  InitiationSet(const Rows& observations, const std::vector<bool>& succeeded, double ridge = 1.0);

  // Returns the success probability, in (0, 1), of a start state with the observation `observation`
  // (O).
  double SuccessProbability(const float* observation) const;

  int size() const { return static_cast<int>(mean_.size()); }  // O

 private:
  Eigen::RowVectorXd mean_, factor_;  // (O) mean of the observations; one over their deviation
  Eigen::VectorXd weights_;           // (O + 1), the last one the bias
};

}  // namespace simwright::rl
