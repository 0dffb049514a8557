#include "rl/side_room.h"

#include <algorithm>
#include <cmath>

#include "rl/link_pose.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tasks::SceneModel;
using tasks::SceneState;

constexpr double kLevel = 0.5;        // of the opening's rise: below, it opens sideways
constexpr double kBehind = 0.03;      // m between the object and the opening's plane
constexpr double kAboveFloor = 0.01;  // m, height of release

// Returns the distance (m) from the receptacle's middle to the plane of its opening.
double HalfDepth(const SideRoom& room) {
  return 0.5 * std::abs(room.box.sizes().dot(room.inward.cwiseAbs()));
}

}  // namespace

std::optional<SideRoom> SideRoomOf(const SceneModel& model, const SceneState& state, int thing,
                                   int link) {
  for (const tasks::Cavity& cavity : model.things[static_cast<size_t>(thing)].cavities) {
    if (cavity.link != link) continue;
    const Isometry3d pose = WorldFromLink(model, state, thing, link);
    if (std::abs((pose.linear() * cavity.opening).z()) > kLevel) return std::nullopt;
    return SideRoom{thing, link, cavity.box, -cavity.opening};
  }
  return std::nullopt;
}

std::optional<SideRoom> SideRoomAround(const SceneModel& model, const SceneState& state,
                                       const Vector3d& point) {
  for (size_t t = 0; t < model.things.size(); ++t) {
    const auto thing = static_cast<int>(t);
    for (const tasks::Cavity& cavity : model.things[t].cavities) {
      const Isometry3d pose = WorldFromLink(model, state, thing, cavity.link);
      if (!cavity.box.contains(pose.inverse() * point)) continue;
      if (std::abs((pose.linear() * cavity.opening).z()) > kLevel) continue;
      return SideRoom{thing, cavity.link, cavity.box, -cavity.opening};
    }
  }
  return std::nullopt;
}

Vector3d InwardOf(const SideRoom& room, const SceneModel& model, const SceneState& state) {
  return WorldFromLink(model, state, room.thing, room.link).linear() * room.inward;
}

bool IsIn(const SideRoom& room, const SceneModel& model, const SceneState& state,
          const Vector3d& point) {
  return room.box.contains(WorldFromLink(model, state, room.thing, room.link).inverse() * point);
}

double DepthIn(const SideRoom& room, const SceneModel& model, const SceneState& state,
               const Vector3d& point) {
  const Vector3d local = WorldFromLink(model, state, room.thing, room.link).inverse() * point;
  return (local - room.box.center()).dot(room.inward) + HalfDepth(room);
}

Vector3d SpotBehindOpening(const SideRoom& room, const SceneModel& model, const SceneState& state,
                           const Vector3d& size) {
  const Vector3d up =
      WorldFromLink(model, state, room.thing, room.link).linear().transpose() * Vector3d::UnitZ();
  const double half_height = 0.5 * std::abs(room.box.sizes().dot(up.cwiseAbs()));
  const double behind = std::min(0.5 * std::max(size.x(), size.y()) + kBehind, HalfDepth(room));
  return room.box.center() + (behind - HalfDepth(room)) * room.inward +
         (0.5 * size.z() + kAboveFloor - half_height) * up;
}

}  // namespace simwright::rl
