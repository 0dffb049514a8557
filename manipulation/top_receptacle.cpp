#include "manipulation/top_receptacle.h"

#include <algorithm>
#include <cmath>

#include "manipulation/link_pose.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tasks::WorldModel;
using tasks::WorldState;

constexpr double kUprightOpening = 0.5;  // of the opening's rise
constexpr double kOpensUpwards = 0.5;    // of a joint axis' rise: a smaller one slides sideways

}  // namespace

bool OpensUpwards(const WorldModel& model, const WorldState& state, int object,
                  const tasks::Receptacle& receptacle) {
  const Isometry3d pose = WorldFromLink(model, state, object, receptacle.link);
  return (pose.linear() * receptacle.opening).z() > kUprightOpening;
}

Vector3d PlacementFromAbove(const WorldModel& model, const WorldState& state, int object,
                            const tasks::Receptacle& receptacle) {
  const tasks::ArticulatedObject& holder = model.objects[static_cast<size_t>(object)];
  const Isometry3d pose = WorldFromLink(model, state, object, receptacle.link);
  Vector3d spot = receptacle.box.center();
  for (size_t j = 0; j < holder.joints.size(); ++j) {
    const tasks::ObjectJoint& joint = holder.joints[j];
    if (joint.link != receptacle.link || joint.type != reward::RewardJointType::kPrismatic)
      continue;
    if (std::abs((pose.linear() * joint.axis).z()) > kOpensUpwards) continue;
    const double length = std::abs(receptacle.box.sizes().dot(joint.axis.cwiseAbs()));
    const double out = std::abs(state.joints[static_cast<size_t>(object)][j] - joint.rest());
    const Vector3d outward = std::copysign(1.0, joint.far() - joint.rest()) * joint.axis;
    spot += 0.5 * std::max(0.0, length - out) * outward;
  }
  return spot;
}

std::optional<double> RimHeightAround(const WorldModel& model, const WorldState& state,
                                      const Vector3d& point) {
  for (size_t t = 0; t < model.objects.size(); ++t) {
    const auto object = static_cast<int>(t);
    for (const tasks::Receptacle& receptacle : model.objects[t].receptacles) {
      const Isometry3d pose = WorldFromLink(model, state, object, receptacle.link);
      if (!receptacle.box.contains(pose.inverse() * point)) continue;
      if (!OpensUpwards(model, state, object, receptacle)) continue;
      return tasks::WorldAabb(model, state, object, receptacle.link).max().z();
    }
  }
  return std::nullopt;
}

}  // namespace simwright::manipulation
