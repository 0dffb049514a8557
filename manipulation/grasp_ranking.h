#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// Returns the point (m, base frame) about which a serial arm on a base reaches: its shoulder.
inline Eigen::Vector3d ShoulderPoint() {
  return {0.0, 0.0, 0.333};
}

// Returns the cost (rad) of a grasp at `world_from_tool`; the lower, the more promising. It is the
// angle from the approach to `reach` (unit, world: from the shoulder to the object) or, plus a
// constant, to the vertical, whichever is smaller; plus terms for a closing axis that is not level,
// for the distance `center_offset` (m) from the line between the contacts to the centre of mass,
// and for perturbed poses that the grasp does not survive (`quality`, Grasp::quality; 0: unknown).
double GraspCost(const Eigen::Isometry3d& world_from_tool, const Eigen::Vector3d& reach,
                 double center_offset, double quality);

// Returns true if an arm whose object lies in the horizontal direction `ahead` (unit, world) may
// approach along `approach` (unit, world): neither from below nor back at itself.
bool IsApproachable(const Eigen::Vector3d& approach, const Eigen::Vector3d& ahead);

// Returns the distance (m) from the line between the contacts of a grasp to `center`, both in the
// object's frame.
double CenterOffset(const Grasp& grasp, const Eigen::Vector3d& center);

// Returns indices into InteractionTarget::grasps, the most promising first, at most 12: grasps that
// an arm may approach from where the object is, and that clear its support if the object stands
// upright. Grasps within 2 cm and 30 degrees of a better one are left out. Empty if the target has
// no grasps, moves by a joint, or is pushed.
std::vector<int> RankGrasps(const Interaction& interaction, const tasks::WorldState& state);

}  // namespace simwright::manipulation
