#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/finding.h"
#include "manipulation/grasp_file.h"
#include "robot/robot_model.h"
#include "tasks/task.h"

namespace simwright::workflows {

// Returns the proved grasps in the folder of an asset; none if it has no grasps.json, or is no
// folder. Throws core::Error for a damaged file.
std::optional<manipulation::GraspSet> ReadAssetGrasps(const std::filesystem::path& asset);

// Returns the grasps of ReadAssetGrasps for the gripper of `robot`. Empty if there are none; if
// they are for another gripper, which is a finding.
std::vector<manipulation::Grasp> GraspsForRobot(const std::filesystem::path& asset,
                                                const robot::RobotModel& robot,
                                                core::Findings* findings);

// Returns true if the gripper of `robot` can take the object off the plane on which it stands by
// one of its proved grasps, false if by none of them; nothing if it has no grasps of this gripper,
// which is a finding if they are another's.
std::optional<bool> HasGraspOnSupport(const std::filesystem::path& asset,
                                      const robot::RobotModel& robot, core::Findings* findings);

// Returns true if an asset of the set has a grasps.json.
bool AnyAssetHasGrasps(const tasks::TaskSet& set);

}  // namespace simwright::workflows
