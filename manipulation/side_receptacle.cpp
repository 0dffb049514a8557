#include "manipulation/side_receptacle.h"

#include <algorithm>
#include <cmath>

#include "manipulation/link_pose.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tasks::WorldModel;
using tasks::WorldState;

constexpr double kOpensSideways = 0.5;  // of the opening's rise: below, it opens sideways
constexpr double kBehind = 0.03;        // m between the object and the opening's plane
constexpr double kAboveFloor = 0.01;    // m, height of release

// Returns the distance (m) from the receptacle's middle to the plane of its opening.
double HalfDepth(const SideReceptacle& room) {
  return 0.5 * std::abs(room.box.sizes().dot(room.inward.cwiseAbs()));
}

}  // namespace

std::optional<SideReceptacle> FindSideReceptacle(const WorldModel& model, const WorldState& state,
                                                 int object, int link) {
  for (const tasks::Receptacle& receptacle :
       model.objects[static_cast<size_t>(object)].receptacles) {
    if (receptacle.link != link) continue;
    const Isometry3d pose = WorldFromLink(model, state, object, link);
    if (std::abs((pose.linear() * receptacle.opening).z()) > kOpensSideways) return std::nullopt;
    return SideReceptacle{object, link, receptacle.box, -receptacle.opening};
  }
  return std::nullopt;
}

std::optional<SideReceptacle> FindSideReceptacleAround(const WorldModel& model,
                                                       const WorldState& state,
                                                       const Vector3d& point) {
  for (size_t t = 0; t < model.objects.size(); ++t) {
    const auto object = static_cast<int>(t);
    for (const tasks::Receptacle& receptacle : model.objects[t].receptacles) {
      const Isometry3d pose = WorldFromLink(model, state, object, receptacle.link);
      if (!receptacle.box.contains(pose.inverse() * point)) continue;
      if (std::abs((pose.linear() * receptacle.opening).z()) > kOpensSideways) continue;
      return SideReceptacle{object, receptacle.link, receptacle.box, -receptacle.opening};
    }
  }
  return std::nullopt;
}

Vector3d InwardDirection(const SideReceptacle& room, const WorldModel& model,
                         const WorldState& state) {
  return WorldFromLink(model, state, room.object, room.link).linear() * room.inward;
}

bool IsIn(const SideReceptacle& room, const WorldModel& model, const WorldState& state,
          const Vector3d& point) {
  return room.box.contains(WorldFromLink(model, state, room.object, room.link).inverse() * point);
}

double DepthIn(const SideReceptacle& room, const WorldModel& model, const WorldState& state,
               const Vector3d& point) {
  const Vector3d local = WorldFromLink(model, state, room.object, room.link).inverse() * point;
  return (local - room.box.center()).dot(room.inward) + HalfDepth(room);
}

Vector3d PlacementBehindOpening(const SideReceptacle& room, const WorldModel& model,
                                const WorldState& state, const Vector3d& size) {
  const Vector3d up =
      WorldFromLink(model, state, room.object, room.link).linear().transpose() * Vector3d::UnitZ();
  const double half_height = 0.5 * std::abs(room.box.sizes().dot(up.cwiseAbs()));
  const double behind = std::min(0.5 * std::max(size.x(), size.y()) + kBehind, HalfDepth(room));
  return room.box.center() + (behind - HalfDepth(room)) * room.inward +
         (0.5 * size.z() + kAboveFloor - half_height) * up;
}

}  // namespace simwright::manipulation
