#include "rl/posture_search.h"

#include <algorithm>
#include <cmath>

namespace simwright::rl {
namespace {

constexpr int kPostures = 8;  // attempts

// Samples a configuration around `from`, within a share of each joint's range to either side.
robot::Posture SampleAround(const robot::Posture& from, double share, const robot::Arm& arm,
                            core::Rng& rng) {
  robot::Posture posture = from;
  for (Eigen::Index j = 0; j < posture.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    const double range = share * (joint.upper - joint.lower);
    posture[j] = std::clamp(from[j] + core::Uniform(rng, -range, range), joint.lower, joint.upper);
  }
  return posture;
}

double TravelTime(const robot::RobotModel& robot, const robot::Posture& displacement) {
  double seconds = 0.0;
  for (Eigen::Index j = 0; j < displacement.size(); ++j) {
    const auto joint = static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)]);
    seconds = std::max(seconds, std::abs(displacement[j]) / robot.limits[joint].velocity);
  }
  return seconds;
}

}  // namespace

std::vector<ReachingPosture> PosturesAt(const Skill& skill, const SkillVariant& variant,
                                        const Eigen::Isometry3d& world_from_tool,
                                        const robot::Posture& from, core::Rng& rng) {
  const Eigen::Isometry3d target =
      variant.subtask.start.world_from_robot.inverse() * world_from_tool;
  std::vector<ReachingPosture> postures;
  robot::Posture start = from;
  for (int i = 0; i < kPostures; ++i) {
    const robot::PoseSolution found = skill.kinematics->Solve(target, start, rng);
    if (found.reached) {
      postures.push_back({found.q, TravelTime(*skill.robot, found.q - from)});
    } else if (i == 0) {
      return postures;  // usually out of reach
    } else {
      continue;
    }
    start = SampleAround(from, static_cast<double>(i + 1) / kPostures, skill.robot->arm, rng);
  }
  return postures;
}

}  // namespace simwright::rl
