#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include "rl/mlp.h"
#include "rl/observation_normalizer.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// The metadata of a file, such as the task's name; keys and values without line breaks.
using Metadata = std::map<std::string, std::string>;

// A trained policy, frozen. Constant and thread-safe.
class Policy {
 public:
  // Throws core::Error if the sizes do not match.
  Policy(const ObservationScale& scale, const Mlp& actor, const Eigen::RowVectorXf& std,
         const Metadata& metadata = {});

  // Writes the mean action for each of `observations` (n x O): (n x A), clamped to [-1, 1].
  void Act(const Rows& observations, Rows* actions) const;

  int observation_size() const { return actor_.input_size(); }  // O
  int action_size() const { return actor_.output_size(); }      // A
  const ObservationScale& scale() const { return scale_; }
  const Mlp& actor() const { return actor_; }
  // Returns the standard deviations (A) of training, for callers that sample actions.
  const Eigen::RowVectorXf& std() const { return std_; }
  const Metadata& metadata() const { return metadata_; }

 private:
  ObservationScale scale_;
  Mlp actor_;
  Eigen::RowVectorXf std_;
  Metadata metadata_;
};

}  // namespace simwright::rl
