#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/scene_state.h"

namespace simwright::rl {

// m before the opening of a room from where a hand goes into it, and to where it comes out.
inline constexpr double kBeforeOpening = 0.1;

// A room that opens to a side, as a microwave's or a cabinet's does: a hand goes into it level or
// leaning, through its opening, and never from above.
struct SideRoom {
  int thing = -1, link = -1;
  Eigen::AlignedBox3d box;  // m, the link's frame: the free box
  // Unit, the link's frame: in through the opening.
  Eigen::Vector3d inward = -Eigen::Vector3d::UnitX();
};

// The largest such room in the link of `thing`, as it stands. None where it has no room, or one
// that opens upwards.
std::optional<SideRoom> SideRoomOf(const tasks::SceneModel& model, const tasks::SceneState& state,
                                   int thing, int link);

// Such a room that `point` (m, world) is in.
std::optional<SideRoom> SideRoomAround(const tasks::SceneModel& model,
                                       const tasks::SceneState& state,
                                       const Eigen::Vector3d& point);

// SideRoom::inward as the room stands (unit, world).
Eigen::Vector3d InwardOf(const SideRoom& room, const tasks::SceneModel& model,
                         const tasks::SceneState& state);

// Whether `point` (m, world) is within the free box.
bool IsIn(const SideRoom& room, const tasks::SceneModel& model, const tasks::SceneState& state,
          const Eigen::Vector3d& point);

// m that `point` (world) is behind the plane of the room's opening; negative before it.
double DepthIn(const SideRoom& room, const tasks::SceneModel& model, const tasks::SceneState& state,
               const Eigen::Vector3d& point);

// Where the middle of a thing of `size` (m, along the world's axes, turned anyhow about the
// upright) goes in the room, m, the link's frame: just behind the middle of the opening, just above
// the floor. That is as deep as a door can close behind it, and as short a way in as there is.
Eigen::Vector3d SpotBehindOpening(const SideRoom& room, const tasks::SceneModel& model,
                                  const tasks::SceneState& state, const Eigen::Vector3d& size);

}  // namespace simwright::rl
