#pragma once

#include <vector>

#include "core/random.h"
#include "manipulation/interaction.h"

namespace simwright::manipulation {

// A solution of the inverse kinematics.
struct IkSolution {
  robot::JointVector configuration;  // (J)
  double seconds = 0.0;              // to reach it, every joint at its highest speed
};

// Solves the inverse kinematics for several configurations with the tool at `world_from_tool`,
// starting from `from` (J) and from random configurations increasingly far from it. Empty if the
// pose is out of reach.
std::vector<IkSolution> SolveIkFromManyStarts(const PlanningArm& context,
                                              const Interaction& interaction,
                                              const Eigen::Isometry3d& world_from_tool,
                                              const robot::JointVector& from, core::Rng& rng);

}  // namespace simwright::manipulation
