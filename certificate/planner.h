#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "certificate/grasp.h"
#include "certificate/robot_clearance.h"
#include "robot/pose_inverse_kinematics.h"
#include "robot/robot_model.h"
#include "sim/driven_robot.h"

namespace simwright::certificate {

// The data of a robot that all plans share, and the grasps of the bodies seen so far. Thread-safe.
class Planner {
 public:
  // `robot` must outlive the planner. Throws core::Error for invalid options.
  explicit Planner(const robot::RobotModel& robot, const GraspOptions& grasps = {},
                   std::uint64_t seed = 1);

  const robot::RobotModel& robot() const { return robot_; }
  const RobotShapes& shapes() const { return shapes_; }
  const std::shared_ptr<const sim::PreparedBody>& physics() const { return physics_; }
  // Returns the grasps of a body: the proved ones, then sampled ones, which are computed once.
  const std::vector<Grasp>& GraspsOf(const std::shared_ptr<const BodyModel>& body) const;

  // Returns the configuration near `start` (J) that brings the tool to a pose in the robot's frame;
  // none if the search from `start` does not arrive.
  std::optional<robot::JointVector> Solve(const Eigen::Isometry3d& robot_from_tool,
                                          const robot::JointVector& start) const;
  // Returns configurations (J) of a tool pose from `count` starts: first `near`, then random ones.
  std::vector<robot::JointVector> Solutions(const Eigen::Isometry3d& robot_from_tool,
                                            const robot::JointVector& near, int count,
                                            core::Rng& rng) const;

 private:
  struct Grasps {
    std::once_flag once;
    std::vector<Grasp> grasps;
  };

  const robot::RobotModel& robot_;
  RobotShapes shapes_;
  std::shared_ptr<const sim::PreparedBody> physics_;
  robot::PoseInverseKinematics kinematics_;
  GraspOptions grasp_options_;
  std::uint64_t seed_;
  mutable std::mutex mutex_;
  mutable std::map<std::shared_ptr<const BodyModel>, std::unique_ptr<Grasps>> grasps_;
};

}  // namespace simwright::certificate
