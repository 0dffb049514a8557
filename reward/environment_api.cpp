#include "reward/environment_api.h"

#include <map>

namespace simwright::reward {
namespace {

using enum RewardInput;
using enum ApiResult;

constexpr ApiFunction kApi[] = {
    {"get_pose_by_link_name get_position_by_asset_link_name get_position_by_link_name "
     "get_pose_by_asset_link_name get_center_by_asset_link_name get_center_by_link_name "
     "get_link_state get_link_position get_link_pose",
     "asset link", kVector, kLinkPosition, 3, "where a link is, m"},
    {"get_orientation_by_link_name get_orientation_by_asset_link_name get_link_orientation "
     "get_quaternion_by_link_name get_quaternion_by_asset_link_name get_rotation_by_link_name",
     "asset link", kVector, kLinkOrientation, 4, "how a link is turned, quaternion xyzw"},
    {"get_linear_velocity_by_link_name get_linear_velocity_by_asset_link_name get_link_velocity "
     "get_link_linear_velocity get_velocity_by_link_name get_velocity_by_asset_link_name",
     "asset link", kVector, kLinkLinearVelocity, 3, "how fast a link moves, m/s"},
    {"get_angular_velocity_by_link_name get_angular_velocity_by_asset_link_name "
     "get_link_angular_velocity",
     "asset link", kVector, kLinkAngularVelocity, 3, "how fast a link turns, rad/s"},
    {"get_position get_pose_by_asset_name get_position_by_asset_name get_asset_position "
     "get_asset_pose get_position_by_name",
     "asset", kVector, kAssetPosition, 3, "where an asset is, m"},
    {"get_orientation get_orientation_by_asset_name get_asset_orientation "
     "get_quaternion_by_asset_name",
     "asset", kVector, kAssetOrientation, 4, "how an asset is turned, quaternion xyzw"},
    {"get_linear_velocity get_velocity get_linear_velocity_by_asset_name get_asset_velocity "
     "get_asset_linear_velocity",
     "asset", kVector, kAssetLinearVelocity, 3, "how fast an asset moves, m/s"},
    {"get_angular_velocity get_angular_velocity_by_asset_name get_asset_angular_velocity", "asset",
     kVector, kAssetAngularVelocity, 3, "how fast an asset turns, rad/s"},
    {"get_robot_gripper_pose get_robot_gripper_position get_gripper_pose get_gripper_position",
     "asset? link?", kVector, kGripperPosition, 3, "between the fingertips, m"},
    {"get_robot_gripper_orientation get_robot_gripper_quaternion get_gripper_orientation", "",
     kVector, kGripperOrientation, 4, "how the gripper is turned, quaternion xyzw"},
    {"get_robot_gripper_velocity get_robot_gripper_linear_velocity get_gripper_velocity", "",
     kVector, kGripperLinearVelocity, 3, "how fast the gripper moves, m/s"},
    {"get_robot_gripper_angular_velocity get_gripper_angular_velocity", "", kVector,
     kGripperAngularVelocity, 3, "how fast the gripper turns, rad/s"},
    {"get_robot_gripper_opening get_robot_gripper_width get_gripper_opening get_gripper_width "
     "get_robot_gripper_state",
     "", kVector, kGripperOpening, 1, "between the fingers, m"},
    {"get_robot_gripper_contact get_gripper_contact check_contact", "asset? link?", kFlag,
     kGripperContact, 1, "a finger touches something, or the thing named"},
    {"check_grasped is_grasped get_grasped get_robot_gripper_grasp", "asset link?", kFlag, kGrasped,
     1, "both fingers hold the asset, or its link"},
    {"get_eef_pos get_eef_pose", "", kPose, kGripperPosition, 3,
     "position and orientation of the gripper"},
    {"get_state_by_joint_name get_state_by_asset_joint_name get_joint_state get_joint_position "
     "get_position_by_joint_name get_joint_state_by_name",
     "asset joint", kVector, kJointState, 1, "how far a joint is open, rad or m"},
    {"get_velocity_by_joint_name get_velocity_by_asset_joint_name get_joint_velocity",
     "asset joint", kVector, kJointVelocity, 1, "how fast a joint moves, rad/s or m/s"},
    {"get_limits_by_joint_name get_limits_by_asset_joint_name get_joint_limits", "asset joint",
     kLimits, kJointLower, 1, "a joint's limits, rad or m"},
    {"get_joint_limit", "asset joint", kLimitPair, kJointLower, 1,
     "a joint's lower and upper limit, rad or m"},
    {"get_joint_lower_limit get_lower_limit_by_joint_name", "asset joint", kLower, kJointLower, 1,
     "rad or m"},
    {"get_joint_upper_limit get_upper_limit_by_joint_name", "asset joint", kUpper, kJointUpper, 1,
     "rad or m"},
    {"get_bounding_box get_bounding_box_by_asset_name", "asset", kBox, kAssetBoundingBox, 6,
     "lowest and highest corner of an asset, m"},
    {"get_bounding_box_link get_bounding_box_by_link_name get_bounding_box_by_asset_link_name",
     "asset link", kBox, kLinkBoundingBox, 6, "lowest and highest corner of a link, m"},
    {"in_bbox in_bounding_box", "point low high", kInsideBox, kParameter, 1,
     "a point lies in a box"},
    {"get_distance get_distance_between", "point point", kDistance, kParameter, 1,
     "between two points, m"},
    {"get_goal_pose get_goal_position", "asset?", kVector, kGoalPosition, 3,
     "where the task wants its asset, m"},
};

template <typename Visit>
void EachName(const ApiFunction& function, const Visit& visit) {
  std::string_view rest = function.names;
  while (!rest.empty()) {
    const std::size_t blank = rest.find(' ');
    visit(rest.substr(0, blank));
    rest = blank == std::string_view::npos ? "" : rest.substr(blank + 1);
  }
}

}  // namespace

std::string_view RewardInputName(RewardInput input) {
  static constexpr std::string_view kNames[] = {"link_position",
                                                "link_orientation",
                                                "link_linear_velocity",
                                                "link_angular_velocity",
                                                "link_bounding_box",
                                                "asset_position",
                                                "asset_orientation",
                                                "asset_linear_velocity",
                                                "asset_angular_velocity",
                                                "asset_bounding_box",
                                                "gripper_position",
                                                "gripper_orientation",
                                                "gripper_linear_velocity",
                                                "gripper_angular_velocity",
                                                "gripper_opening",
                                                "gripper_contact",
                                                "grasped",
                                                "joint_state",
                                                "joint_velocity",
                                                "joint_lower",
                                                "joint_upper",
                                                "goal_position",
                                                "parameter"};
  return kNames[static_cast<int>(input)];
}

std::span<const ApiFunction> EnvironmentApi() {
  return kApi;
}

const ApiFunction* FindApiFunction(std::string_view name) {
  static const auto* by_name = [] {
    auto* all = new std::map<std::string_view, const ApiFunction*>;
    for (const ApiFunction& function : kApi) {
      EachName(function, [&](std::string_view alias) { all->emplace(alias, &function); });
    }
    return all;
  }();
  const auto found = by_name->find(name);
  return found == by_name->end() ? nullptr : found->second;
}

bool IsEnvironmentName(std::string_view name) {
  return name == "env" || name == "self" || name == "simulator" || name == "envs";
}

std::vector<std::string> ApiNames() {
  std::vector<std::string> names;
  for (const ApiFunction& function : kApi) {
    EachName(function, [&](std::string_view alias) { names.emplace_back(alias); });
  }
  return names;
}

}  // namespace simwright::reward
