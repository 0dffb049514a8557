#include "workflows/grasps/asset_grasps.h"

#include <algorithm>
#include <string>

#include "core/error.h"

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
  std::string gripper = "that of the robot '" + robot.name + "'";
  try {
    if (manipulation::IsForGripper(*set, manipulation::GripperOf(robot))) return set->grasps;
  } catch (const core::Error& error) {
    gripper += ", which has no parallel gripper";
  }
  findings->push_back({"grasps-other-gripper", core::Severity::kWarning,
                       (asset / manipulation::kGraspFileName).string(),
                       "the grasps are for the gripper '" + set->gripper + "', not for " + gripper +
                           ", and are not used",
                       0.0, "prove grasps of this gripper with `simwright grasps --gripper`"});
  return {};
}

std::optional<bool> HasGraspOnSupport(const fs::path& asset, const robot::RobotModel& robot,
                                      core::Findings* findings) {
  const std::vector<manipulation::Grasp> grasps = GraspsForRobot(asset, robot, findings);
  if (grasps.empty()) return std::nullopt;
  return std::any_of(grasps.begin(), grasps.end(),
                     [](const manipulation::Grasp& grasp) { return grasp.clears_support; });
}

bool AnyAssetHasGrasps(const tasks::TaskSet& set) {
  return std::any_of(set.assets.begin(), set.assets.end(), [](const tasks::TaskAsset& asset) {
    return fs::is_regular_file(fs::path(asset.path) / manipulation::kGraspFileName);
  });
}

}  // namespace simwright::workflows
