#include "workflows/grasps/asset_grasps.h"

#include <algorithm>

namespace simwright::workflows {
namespace fs = std::filesystem;

std::optional<manipulation::GraspSet> ReadAssetGrasps(const fs::path& asset) {
  const fs::path file = asset / manipulation::kGraspFileName;
  if (!fs::is_regular_file(file)) return std::nullopt;
  return manipulation::ReadGraspSet(file);
}

std::vector<manipulation::Grasp> GraspsForRobot(const fs::path& asset,
                                                const robot::RobotModel& robot,
                                                core::Findings* findings) {
  const std::optional<manipulation::GraspSet> set = ReadAssetGrasps(asset);
  if (!set) return {};
  if (manipulation::IsForGripper(*set, manipulation::GripperOf(robot))) return set->grasps;
  findings->push_back({"grasps-other-gripper", core::Severity::kWarning,
                       (asset / manipulation::kGraspFileName).string(),
                       "the grasps are for the gripper '" + set->gripper +
                           "', not for that of the robot '" + robot.name + "', and are not used",
                       0.0, "prove grasps of this gripper with `simwright grasps --gripper`"});
  return {};
}

std::optional<bool> HasGraspOnSupport(const fs::path& asset) {
  const std::optional<manipulation::GraspSet> set = ReadAssetGrasps(asset);
  if (!set) return std::nullopt;
  return std::any_of(set->grasps.begin(), set->grasps.end(),
                     [](const manipulation::Grasp& grasp) { return grasp.clears_support; });
}

}  // namespace simwright::workflows
