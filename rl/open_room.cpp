#include "rl/open_room.h"

#include <algorithm>
#include <cmath>

#include "rl/link_pose.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tasks::SceneModel;
using tasks::SceneState;

constexpr double kUpright = 0.5;  // of the opening's rise
constexpr double kLevel = 0.5;    // of a joint axis' rise: a smaller one slides sideways

}  // namespace

bool OpensUpwards(const SceneModel& model, const SceneState& state, int thing,
                  const tasks::Cavity& cavity) {
  const Isometry3d pose = WorldFromLink(model, state, thing, cavity.link);
  return (pose.linear() * cavity.opening).z() > kUpright;
}

Vector3d SpotFromAbove(const SceneModel& model, const SceneState& state, int thing,
                       const tasks::Cavity& cavity) {
  const tasks::Thing& holder = model.things[static_cast<size_t>(thing)];
  const Isometry3d pose = WorldFromLink(model, state, thing, cavity.link);
  Vector3d spot = cavity.box.center();
  for (size_t j = 0; j < holder.joints.size(); ++j) {
    const tasks::ThingJoint& joint = holder.joints[j];
    if (joint.link != cavity.link || joint.type != tasks::RewardJointType::kPrismatic) continue;
    if (std::abs((pose.linear() * joint.axis).z()) > kLevel) continue;
    const double length = std::abs(cavity.box.sizes().dot(joint.axis.cwiseAbs()));
    const double out = std::abs(state.joints[static_cast<size_t>(thing)][j] - joint.rest());
    const Vector3d outward = std::copysign(1.0, joint.far() - joint.rest()) * joint.axis;
    spot += 0.5 * std::max(0.0, length - out) * outward;
  }
  return spot;
}

std::optional<double> RimAround(const SceneModel& model, const SceneState& state,
                                const Vector3d& point) {
  for (size_t t = 0; t < model.things.size(); ++t) {
    const auto thing = static_cast<int>(t);
    for (const tasks::Cavity& cavity : model.things[t].cavities) {
      const Isometry3d pose = WorldFromLink(model, state, thing, cavity.link);
      if (!cavity.box.contains(pose.inverse() * point)) continue;
      if (!OpensUpwards(model, state, thing, cavity)) continue;
      return tasks::WorldBox(model, state, thing, cavity.link).max().z();
    }
  }
  return std::nullopt;
}

}  // namespace simwright::rl
