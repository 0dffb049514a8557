#include "certificate/planner.h"

#include "core/error.h"

namespace simwright::certificate {
namespace {

constexpr double kSameConfiguration = 0.1;  // rad or m of any joint

robot::PoseInverseKinematicsOptions KinematicsOptions() {
  robot::PoseInverseKinematicsOptions options;
  options.position_tolerance = 1e-4;
  options.angle_tolerance = 1e-3;
  options.starts = 1;
  return options;
}

}  // namespace

Planner::Planner(const robot::RobotModel& robot, const GraspOptions& grasps, std::uint64_t seed)
    : robot_(robot),
      shapes_(robot),
      physics_(sim::RobotBody(robot)),
      kinematics_(robot.arm, KinematicsOptions()),
      grasp_options_(grasps),
      seed_(seed) {
  std::string error;
  if (!grasps.IsValid(&error)) throw core::Error(error, "grasp search");
}

const std::vector<Grasp>& Planner::GraspsOf(const std::shared_ptr<const BodyModel>& body) const {
  Grasps* entry = nullptr;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::unique_ptr<Grasps>& slot = grasps_[body];
    if (!slot) slot = std::make_unique<Grasps>();
    entry = slot.get();
  }
  std::call_once(entry->once, [&] {
    entry->grasps = ProvedGraspsOf(*body, robot_);
    if (!entry->grasps.empty() && grasp_options_.proved_alone) return;
    const std::vector<Grasp> sampled = SampleGrasps(*body, robot_, seed_, grasp_options_);
    entry->grasps.insert(entry->grasps.end(), sampled.begin(), sampled.end());
  });
  return entry->grasps;
}

std::optional<robot::JointVector> Planner::Solve(const Eigen::Isometry3d& robot_from_tool,
                                                 const robot::JointVector& start) const {
  core::Rng unused;
  const robot::PoseSolution solution = kinematics_.Solve(robot_from_tool, start, unused);
  if (!solution.reached) return std::nullopt;
  return solution.q;
}

std::vector<robot::JointVector> Planner::Solutions(const Eigen::Isometry3d& robot_from_tool,
                                                   const robot::JointVector& near, int count,
                                                   core::Rng& rng) const {
  std::vector<robot::JointVector> solutions;
  for (int i = 0; i < count; ++i) {
    robot::JointVector start = near;
    for (Eigen::Index j = 0; i > 0 && j < start.size(); ++j) {
      const robot::ArmJoint& joint = robot_.arm.joints[static_cast<size_t>(j)];
      start[j] = core::Uniform(rng, joint.lower, joint.upper);
    }
    const auto found = Solve(robot_from_tool, start);
    if (!found) continue;
    const bool known = std::any_of(solutions.begin(), solutions.end(), [&](const auto& one) {
      return (one - *found).template lpNorm<Eigen::Infinity>() < kSameConfiguration;
    });
    if (!known) solutions.push_back(*found);
  }
  return solutions;
}

}  // namespace simwright::certificate
