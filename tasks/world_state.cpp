#include "tasks/world_state.h"

#include "core/error.h"
#include "robot/panda.h"
#include "tasks/reward_names.h"

namespace simwright::tasks {

int WorldModel::Find(const std::string& wanted) const {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].name == wanted) return static_cast<int>(i);
  }
  return -1;
}

WorldModel MakeWorldModel(const std::vector<assets::SemanticModel>& models) {
  WorldModel scene;
  for (const assets::SemanticModel& model : models) {
    if (scene.Find(model.name) >= 0) {
      throw core::Error("two assets are called '" + model.name + "'", model.urdf.string(),
                        "give one another name: NAME=PATH");
    }
    scene.objects.push_back(MakeArticulatedObject(model.name, model));
    scene.names.assets.push_back(MakeRewardAsset(model.name, model.model));
  }
  return scene;
}

WorldState StateOf(const WorldModel& model, const InitialState& start,
                   const std::optional<Eigen::Vector3d>& goal) {
  WorldState state;
  const Eigen::Isometry3d away(Eigen::Translation3d(0, 0, -100));
  state.roots.assign(model.objects.size(), away);
  for (const ArticulatedObject& object : model.objects)
    state.joints.push_back(RestPositions(object));
  const auto find = [&](const std::string& name) {
    const int object = model.Find(name);
    if (object < 0) throw core::Error("there is no asset '" + name + "'", "initial state");
    return static_cast<std::size_t>(object);
  };
  for (const AssetPlacement& placement : start.placements) {
    state.roots[find(placement.asset)] = placement.world_from_asset;
  }
  for (const JointCondition& condition : start.joints) {
    const std::size_t object = find(condition.asset);
    const int joint = model.objects[object].FindJoint(condition.joint);
    if (joint < 0) {
      throw core::Error("'" + condition.asset + "' has no joint '" + condition.joint + "'",
                        "initial state");
    }
    state.joints[object][static_cast<std::size_t>(joint)] = condition.position;
  }
  state.gripper =
      start.world_from_robot * robot::ForwardKinematics(robot::PandaArm(), robot::PandaArm().ready);
  if (!start.held.empty()) {
    const int held = static_cast<int>(find(start.held));
    state.touched = held;
    state.touched_link = 0;
    state.grasped = true;
    const Eigen::AlignedBox3d box = WorldAabb(model, state, held);
    state.gripper.translation() = box.center();
    state.opening = std::min(robot::kPandaGripperOpening, box.sizes().head<2>().minCoeff());
  }
  if (goal) state.goal = *goal;
  return state;
}

Eigen::Vector3d LinkPosition(const WorldModel& model, const WorldState& state, int object,
                             int link) {
  const auto t = static_cast<std::size_t>(object);
  const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(model.objects[t], state.joints[t]);
  const auto l = static_cast<std::size_t>(link);
  return state.roots[t] * poses[l] * model.objects[t].links[l].middle;
}

Eigen::AlignedBox3d WorldAabb(const WorldModel& model, const WorldState& state, int object,
                              int link) {
  const auto t = static_cast<std::size_t>(object);
  const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(model.objects[t], state.joints[t]);
  Eigen::AlignedBox3d box;
  for (std::size_t l = 0; l < poses.size(); ++l) {
    if (link >= 0 && l != static_cast<std::size_t>(link)) continue;
    const Eigen::Isometry3d pose = state.roots[t] * poses[l];
    for (const Eigen::Vector3d& point : model.objects[t].links[l].extreme_points)
      box.extend(pose * point);
  }
  if (box.isEmpty()) box.extend(state.roots[t].translation());
  return box;
}

}  // namespace simwright::tasks
