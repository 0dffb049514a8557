#pragma once

#include <vector>

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// From which states a skill succeeds, as far as can be told from starts that it was tried from:
// logistic regression on what its policy observes there. (Chained policies call it the initiation
// set; Lee et al., CoRL 2021, tell it by a network.)
class InitiationSet {
 public:
  // `observations` (n x O), of which those that are `succeeded` (n) led to success. `ridge` > 0
  // holds the weights down where starts are few. Throws core::Error where there are no starts, or
  // other lengths.
  InitiationSet(const Rows& observations, const std::vector<bool>& succeeded, double ridge = 1.0);

  // Of success from a start that is observed as `observation` (O), in (0, 1).
  double Chance(const float* observation) const;

  int size() const { return static_cast<int>(mean_.size()); }  // O

 private:
  Eigen::RowVectorXd mean_, factor_;  // (O) of what was observed; one over its deviation
  Eigen::VectorXd weights_;           // (O + 1), the last one alone
};

}  // namespace simwright::rl
