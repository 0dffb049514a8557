#include "tasks/reward_names.h"

#include <numbers>
#include <optional>

namespace simwright::tasks {
namespace {

std::optional<reward::RewardJointType> TypeOf(assets::JointType type) {
  switch (type) {
    case assets::JointType::kFixed:
      return reward::RewardJointType::kFixed;
    case assets::JointType::kRevolute:
      return reward::RewardJointType::kRevolute;
    case assets::JointType::kContinuous:
      return reward::RewardJointType::kContinuous;
    case assets::JointType::kPrismatic:
      return reward::RewardJointType::kPrismatic;
    case assets::JointType::kFloating:
    case assets::JointType::kPlanar:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

reward::RewardAsset MakeRewardAsset(const std::string& name, const assets::UrdfModel& model) {
  reward::RewardAsset asset;
  asset.name = name;
  for (const assets::UrdfLink& link : model.links) asset.links.push_back(link.name);
  for (const assets::Joint& joint : model.joints) {
    const std::optional<reward::RewardJointType> type = TypeOf(joint.type);
    if (!type) continue;
    reward::RewardJoint names{joint.name, *type, joint.lower, joint.upper};
    if (*type == reward::RewardJointType::kFixed) names.lower = names.upper = 0.0;
    if (*type == reward::RewardJointType::kContinuous) {  // the state wraps around
      names.lower = -std::numbers::pi;
      names.upper = std::numbers::pi;
    }
    asset.joints.push_back(names);
  }
  return asset;
}

}  // namespace simwright::tasks
