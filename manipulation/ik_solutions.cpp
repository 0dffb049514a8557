#include "manipulation/ik_solutions.h"

#include <algorithm>
#include <cmath>

namespace simwright::manipulation {
namespace {

constexpr int kConfigurations = 8;  // attempts

// Samples a configuration around `from`, within a share of each joint's range to either side.
robot::JointVector SampleAround(const robot::JointVector& from, double share, const robot::Arm& arm,
                                core::Rng& rng) {
  robot::JointVector configuration = from;
  for (Eigen::Index j = 0; j < configuration.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    const double range = share * (joint.upper - joint.lower);
    configuration[j] =
        std::clamp(from[j] + core::Uniform(rng, -range, range), joint.lower, joint.upper);
  }
  return configuration;
}

double TravelTime(const robot::RobotModel& robot, const robot::JointVector& displacement) {
  double seconds = 0.0;
  for (Eigen::Index j = 0; j < displacement.size(); ++j) {
    const auto joint = static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)]);
    seconds = std::max(seconds, std::abs(displacement[j]) / robot.limits[joint].velocity);
  }
  return seconds;
}

}  // namespace

std::vector<IkSolution> SolveIkFromManyStarts(const PlanningArm& context,
                                              const Interaction& interaction,
                                              const Eigen::Isometry3d& world_from_tool,
                                              const robot::JointVector& from, core::Rng& rng) {
  const Eigen::Isometry3d target =
      interaction.subtask.start.world_from_robot.inverse() * world_from_tool;
  std::vector<IkSolution> configurations;
  robot::JointVector start = from;
  for (int i = 0; i < kConfigurations; ++i) {
    const robot::PoseSolution found = context.kinematics->Solve(target, start, rng);
    if (found.reached) {
      configurations.push_back({found.q, TravelTime(*context.robot, found.q - from)});
    } else if (i == 0) {
      return configurations;  // usually out of reach
    } else {
      continue;
    }
    start =
        SampleAround(from, static_cast<double>(i + 1) / kConfigurations, context.robot->arm, rng);
  }
  return configurations;
}

}  // namespace simwright::manipulation
