#include "tasks/reward_names.h"

#include <numbers>
#include <optional>

namespace simwright::tasks {
namespace {

std::optional<RewardJointType> TypeOf(assets::UrdfJointType type) {
  switch (type) {
    case assets::UrdfJointType::kFixed:
      return RewardJointType::kFixed;
    case assets::UrdfJointType::kRevolute:
      return RewardJointType::kRevolute;
    case assets::UrdfJointType::kContinuous:
      return RewardJointType::kContinuous;
    case assets::UrdfJointType::kPrismatic:
      return RewardJointType::kPrismatic;
    case assets::UrdfJointType::kFloating:
    case assets::UrdfJointType::kPlanar:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

RewardAsset NamesOf(const std::string& name, const assets::UrdfModel& model) {
  RewardAsset asset;
  asset.name = name;
  for (const assets::UrdfLink& link : model.links) asset.links.push_back(link.name);
  for (const assets::UrdfJoint& joint : model.joints) {
    const std::optional<RewardJointType> type = TypeOf(joint.type);
    if (!type) continue;
    RewardJoint names{joint.name, *type, joint.lower, joint.upper};
    if (*type == RewardJointType::kFixed) names.lower = names.upper = 0.0;
    if (*type == RewardJointType::kContinuous) {  // the state wraps around
      names.lower = -std::numbers::pi;
      names.upper = std::numbers::pi;
    }
    asset.joints.push_back(names);
  }
  return asset;
}

}  // namespace simwright::tasks
