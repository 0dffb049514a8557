// A robot's side file from anywhere, beside a small URDF: core::Error, or a robot whose joints,
// links, limits and home fit that URDF; nothing else.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "core/files.h"
#include "robot/chain_kinematics.h"
#include "robot/robot_model.h"
#include "temporary_file.h"

namespace {

using namespace simwright;

constexpr const char* kUrdf = R"(<robot name="arm">
<link name="base"/><link name="arm"/><link name="hand"/><link name="finger"/><link name="thumb"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="lift" type="prismatic"><parent link="arm"/><child link="hand"/>
<axis xyz="0 0 1"/><limit lower="0" upper="0.5" velocity="1" effort="1"/></joint>
<joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/>
<axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
<joint name="follow" type="prismatic"><parent link="hand"/><child link="thumb"/>
<axis xyz="0 -1 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/>
<mimic joint="grip"/></joint></robot>)";

void RequireSound(const robot::RobotModel& model) {
  const auto joints = static_cast<int>(model.urdf.joints.size());
  const auto links = static_cast<int>(model.urdf.links.size());
  const auto require = [](int index, int count) {
    if (index < 0 || index >= count) std::abort();
  };
  for (const int joint : model.arm_joints) require(joint, joints);
  for (const int joint : model.gripper.joints) require(joint, joints);
  for (const int link : model.gripper.links) require(link, links);
  for (const auto& [a, b] : model.ignored_collisions) {
    require(a, links);
    require(b, links);
  }
  require(model.tool_link, links);
  if (model.arm.size() < 1 || model.home().size() != model.arm.size()) std::abort();
  for (int j = 0; j < model.arm.size(); ++j) {
    const robot::JointLimits limits = model.ArmLimits()[static_cast<std::size_t>(j)];
    if (!(model.home()[j] >= limits.lower && model.home()[j] <= limits.upper)) std::abort();
    if (!(robot::CommandLimits(limits, model.margin).velocity > 0.0)) std::abort();
  }
  if (!robot::ChainKinematics(model.arm).Tool(model.home()).matrix().allFinite()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::TemporaryFile file("arm.json");
  const std::filesystem::path side = file.Write(data, size);
  const std::filesystem::path urdf = side.parent_path() / "arm.urdf";
  if (!std::filesystem::exists(urdf)) core::WriteFile(urdf, kUrdf);
  try {
    RequireSound(robot::ReadRobot(urdf));
  } catch (const core::Error&) {
  }
  return 0;
}
