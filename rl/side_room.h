#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/scene_state.h"

namespace simwright::rl {

// The distance (m) in front of the opening of a receptacle from where a gripper enters it, and to
// where it retreats.
inline constexpr double kBeforeOpening = 0.1;

// A side-opening receptacle, such as a microwave or a cabinet: a gripper enters it level or
// leaning, through its opening, never from above.
struct SideRoom {
  int thing = -1, link = -1;
  Eigen::AlignedBox3d box;  // m, link frame: the free box
  // The inward direction through the opening; unit, link frame.
  Eigen::Vector3d inward = -Eigen::Vector3d::UnitX();
};

// Returns the largest side-opening receptacle in the link of `thing` in `state`. None if the link
// has no receptacle, or one that opens upwards.
std::optional<SideRoom> SideRoomOf(const tasks::SceneModel& model, const tasks::SceneState& state,
                                   int thing, int link);

// Returns the side-opening receptacle that contains `point` (m, world).
std::optional<SideRoom> SideRoomAround(const tasks::SceneModel& model,
                                       const tasks::SceneState& state,
                                       const Eigen::Vector3d& point);

// Returns SideRoom::inward in the world frame (unit) for `state`.
Eigen::Vector3d InwardOf(const SideRoom& room, const tasks::SceneModel& model,
                         const tasks::SceneState& state);

// Returns true if `point` (m, world) is within the free box.
bool IsIn(const SideRoom& room, const tasks::SceneModel& model, const tasks::SceneState& state,
          const Eigen::Vector3d& point);

// Returns the depth (m) of `point` (world) behind the plane of the opening; negative in front of
// it.
double DepthIn(const SideRoom& room, const tasks::SceneModel& model, const tasks::SceneState& state,
               const Eigen::Vector3d& point);

// Returns the position (m, link frame) in the receptacle for the middle of an object of `size` (m,
// along the world axes, with any orientation about the vertical): just behind the middle of the
// opening, just above the floor. A door still closes in front of it, and the path into the
// receptacle is the shortest.
Eigen::Vector3d SpotBehindOpening(const SideRoom& room, const tasks::SceneModel& model,
                                  const tasks::SceneState& state, const Eigen::Vector3d& size);

}  // namespace simwright::rl
