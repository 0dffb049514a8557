#include "sim/driven_robot.h"

#include <algorithm>
#include <vector>

#include "assets/joint_poses.h"

namespace simwright::sim {
namespace {

constexpr double kInFloor = 1e-3;     // m
constexpr double kFingerLead = 0.01;  // m

}  // namespace

std::vector<int> LinksInFloor(const ArticulatedBody& body, const robot::RobotModel& model,
                              const Eigen::Isometry3d& world_from_robot) {
  std::vector<int> links;
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model.urdf);
  for (size_t i = 0; i < body.links.size(); ++i) {
    if (body.links[i].parts.empty()) continue;
    if (LowestPoint(body.links[i], world_from_robot * poses[i]) < -kInFloor) {
      links.push_back(static_cast<int>(i));
    }
  }
  return links;
}

std::shared_ptr<const PreparedBody> RobotBody(const robot::RobotModel& model) {
  return std::make_shared<PreparedBody>(ArticulatedBodyFrom(model.urdf, model.kinematics));
}

DrivenRobot::DrivenRobot(const robot::RobotModel& model, std::shared_ptr<const PreparedBody> body,
                         const Eigen::Isometry3d& world_from_robot, ArticulatedWorld* world,
                         const MotorOptions& options)
    : model_(model), world_(*world), gain_(options.stiffness / world->time_step()) {
  Placement placement;
  placement.world_from_root = world_from_robot;
  placement.through_floor = LinksInFloor(body->body(), model, world_from_robot);
  if (options.finger_friction) {
    for (const int link : model.gripper.links) {
      placement.link_friction.emplace_back(link, *options.finger_friction);
    }
  }
  body_ = world_.Add(std::move(body), placement);
  for (const int joint : model.gripper.joints) {
    world_.LimitMimic(body_, joint, options.centring * model.gripper.grip_force);
  }
  Place(model.home(), model.gripper.open);
}

void DrivenRobot::Place(const Eigen::VectorXd& arm, double leader) {
  for (size_t j = 0; j < model_.arm_joints.size(); ++j) {
    world_.SetPosition(body_, model_.arm_joints[j], arm[static_cast<Eigen::Index>(j)]);
  }
  for (const int joint : model_.gripper.joints) world_.SetPosition(body_, joint, leader);
  finger_set_point_ = leader;
  Command(arm, leader);
}

void DrivenRobot::Command(const Eigen::VectorXd& arm, double leader) {
  arm_command_ = arm;
  leader_command_ = leader;
}

void DrivenRobot::DriveJoint(int joint, double target, double force) {
  const double limit = model_.limits[static_cast<size_t>(joint)].velocity;
  const double error = target - world_.Position(body_, joint);
  const double target_velocity =
      limit > 0.0 ? std::clamp(gain_ * error, -limit, limit) : gain_ * error;
  world_.Drive(body_, joint, target_velocity, force);
}

void DrivenRobot::Drive() {
  for (size_t j = 0; j < model_.arm_joints.size(); ++j) {
    const int joint = model_.arm_joints[j];
    const double effort = model_.limits[static_cast<size_t>(joint)].effort;
    DriveJoint(joint, arm_command_[static_cast<Eigen::Index>(j)], effort);
  }
  DriveFingers();
}

// Drives the fingers to a set point that moves at their speed limit. If an object stops them, the
// set point runs ahead until the motors ask for far more speed than the fingers have: the solver
// then reaches the full grip force in a few iterations, while a target at the fingers' own speed
// adds a hundredth of it in each.
void DrivenRobot::DriveFingers() {
  const int leader = model_.gripper.joints.front();
  const double now = world_.Position(body_, leader);
  const double step = model_.limits[static_cast<size_t>(leader)].velocity * world_.time_step();
  if ((leader_command_ - now) * (finger_set_point_ - now) < 0.0) finger_set_point_ = now;
  finger_set_point_ += std::clamp(leader_command_ - finger_set_point_, -step, step);
  finger_set_point_ = std::clamp(finger_set_point_, now - kFingerLead, now + kFingerLead);
  for (const int joint : model_.gripper.joints) {
    const double error = finger_set_point_ - world_.Position(body_, joint);
    world_.Drive(body_, joint, gain_ * error, model_.gripper.grip_force);
  }
}

void DrivenRobot::Positions(Eigen::VectorXd* arm) const {
  arm->resize(static_cast<Eigen::Index>(model_.arm_joints.size()));
  for (size_t j = 0; j < model_.arm_joints.size(); ++j) {
    (*arm)[static_cast<Eigen::Index>(j)] = world_.Position(body_, model_.arm_joints[j]);
  }
}

void DrivenRobot::Velocities(Eigen::VectorXd* arm) const {
  arm->resize(static_cast<Eigen::Index>(model_.arm_joints.size()));
  for (size_t j = 0; j < model_.arm_joints.size(); ++j) {
    (*arm)[static_cast<Eigen::Index>(j)] = world_.Velocity(body_, model_.arm_joints[j]);
  }
}

double DrivenRobot::Leader() const {
  return world_.Position(body_, model_.gripper.joints.front());
}

Eigen::Isometry3d DrivenRobot::Tool() const {
  return world_.LinkPose(body_, model_.tool_link);
}

}  // namespace simwright::sim
