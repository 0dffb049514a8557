#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include "rl/mlp.h"
#include "rl/observation_normalizer.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// What else a file says of itself, such as the task's name; keys and values without line breaks.
using Facts = std::map<std::string, std::string>;

// A trained policy, frozen. Constant, and safe from several threads.
class Policy {
 public:
  // Throws core::Error where the sizes do not fit each other.
  Policy(const ObservationScale& scale, const Mlp& actor, const Eigen::RowVectorXf& std,
         const Facts& facts = {});

  // The most probable action for each of `observations` (n x O): (n x A), clamped to [-1, 1].
  void Act(const Rows& observations, Rows* actions) const;

  int observation_size() const { return actor_.input_size(); }  // O
  int action_size() const { return actor_.output_size(); }      // A
  const ObservationScale& scale() const { return scale_; }
  const Mlp& actor() const { return actor_; }
  // (A) that training drew with, for whoever wants to draw.
  const Eigen::RowVectorXf& std() const { return std_; }
  const Facts& facts() const { return facts_; }

 private:
  ObservationScale scale_;
  Mlp actor_;
  Eigen::RowVectorXf std_;
  Facts facts_;
};

}  // namespace simwright::rl
