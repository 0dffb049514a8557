#pragma once

#include <vector>

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// The configurations of an arm along the joint path of its target, with the tool at the grasp.
struct PathConfigurations {
  std::vector<double> positions;  // rad or m, of the target joint, from its current one on
  std::vector<robot::JointVector> configurations;  // (J) one for each position
  bool ends_early = false;                         // the tool cannot follow the whole joint path

  // Interpolates linearly; clamps beyond the first and last. Requires at least one configuration.
  robot::JointVector At(double position) const;
};

// Returns the continuous sequence of configurations from `grasp_configuration` (J) with approach
// pitch `pitch` (rad), as PlanReach checks it: as far as the tool can follow. Empty if the skill
// moves no joint, or if the tool is not at the grasp in `grasp_configuration`.
PathConfigurations ConfigurationsAlongJoint(const PlanningArm& context,
                                            const Interaction& interaction, tasks::WorldState state,
                                            const robot::JointVector& grasp_configuration,
                                            double pitch);

}  // namespace simwright::manipulation
