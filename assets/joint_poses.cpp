#include "assets/joint_poses.h"

namespace simwright::assets {
namespace {

double PositionOf(const Joint& joint, const JointPositions& positions) {
  const auto found = positions.find(joint.mimic ? joint.mimic->joint : joint.name);
  const double position = found == positions.end() ? 0.0 : found->second;
  return joint.mimic ? joint.mimic->multiplier * position + joint.mimic->offset : position;
}

}  // namespace

std::vector<int> ParentLinks(const UrdfModel& model) {
  std::map<std::string, int> index_of;
  for (size_t i = 0; i < model.links.size(); ++i) {
    index_of[model.links[i].name] = static_cast<int>(i);
  }
  std::vector<int> parents;
  for (const Joint& joint : model.joints) parents.push_back(index_of.at(joint.parent));
  return parents;
}

std::vector<Eigen::Isometry3d> LinkPoses(const UrdfModel& model, const JointPositions& positions) {
  const std::vector<int> parents = ParentLinks(model);
  std::vector<Eigen::Isometry3d> poses(model.links.size(), Eigen::Isometry3d::Identity());
  for (size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    poses[i + 1] = poses[static_cast<size_t>(parents[i])] * joint.parent_from_joint *
                   JointMotion(joint, PositionOf(joint, positions));
  }
  return poses;
}

std::vector<Eigen::Isometry3d> LinkPosesAtZero(const UrdfModel& model) {
  const std::vector<int> parents = ParentLinks(model);
  std::vector<Eigen::Isometry3d> poses(model.links.size(), Eigen::Isometry3d::Identity());
  for (size_t i = 0; i < model.joints.size(); ++i) {
    poses[i + 1] = poses[static_cast<size_t>(parents[i])] * model.joints[i].parent_from_joint;
  }
  return poses;
}

}  // namespace simwright::assets
