#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/world_state.h"

namespace simwright::manipulation {

// The distance (m) in front of the opening of a receptacle from where a gripper enters it, and to
// where it retreats.
inline constexpr double kEntryDistance = 0.1;

// A side-opening receptacle, such as a microwave or a cabinet: a gripper enters it level or
// leaning, through its opening, never from above.
struct SideReceptacle {
  int object = -1, link = -1;
  Eigen::AlignedBox3d box;  // m, link frame: the free box
  // The inward direction through the opening; unit, link frame.
  Eigen::Vector3d inward = -Eigen::Vector3d::UnitX();
};

// Returns the largest side-opening receptacle in the link of `object` in `state`. None if the link
// has no receptacle, or one that opens upwards.
std::optional<SideReceptacle> FindSideReceptacle(const tasks::WorldModel& model,
                                                 const tasks::WorldState& state, int object,
                                                 int link);

// Returns the side-opening receptacle that contains `point` (m, world).
std::optional<SideReceptacle> FindSideReceptacleAround(const tasks::WorldModel& model,
                                                       const tasks::WorldState& state,
                                                       const Eigen::Vector3d& point);

// Returns SideReceptacle::inward in the world frame (unit) for `state`.
Eigen::Vector3d InwardDirection(const SideReceptacle& room, const tasks::WorldModel& model,
                                const tasks::WorldState& state);

// Returns true if `point` (m, world) is within the free box.
bool IsIn(const SideReceptacle& room, const tasks::WorldModel& model,
          const tasks::WorldState& state, const Eigen::Vector3d& point);

// Returns the depth (m) of `point` (world) behind the plane of the opening; negative in front of
// it.
double DepthIn(const SideReceptacle& room, const tasks::WorldModel& model,
               const tasks::WorldState& state, const Eigen::Vector3d& point);

// Returns the position (m, link frame) in the receptacle for the middle of an object of `size` (m,
// along the world axes, with any orientation about the vertical): just behind the middle of the
// opening, just above the floor. A door still closes in front of it, and the path into the
// receptacle is the shortest.
Eigen::Vector3d PlacementBehindOpening(const SideReceptacle& room, const tasks::WorldModel& model,
                                       const tasks::WorldState& state, const Eigen::Vector3d& size);

}  // namespace simwright::manipulation
