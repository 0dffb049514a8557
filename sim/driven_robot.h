#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.h"
#include "sim/articulated_world.h"

namespace simwright::sim {

struct MotorOptions {
  // Share of a position error that a motor makes good in one step. Near 1 a hard hit rings on.
  double stiffness = 0.3;
  // Share of the grip force that keeps the fingers alike. A real arm gives way until both fingers
  // press on what is between them; this one is stiff, so that the hand gives way: with 1 or more
  // one finger alone presses on a handle that is a millimetre off the middle, and slides off it.
  double centring = 0.9;
  // Coefficient of the fingers' surfaces; none: the URDF's.
  std::optional<double> finger_friction = std::nullopt;
};

// A robot in a world, each joint held at its commanded position by a motor within the joint's
// limits of effort and velocity, the fingers with the grip force. The motors are implicit: solved
// with the contacts, so stable at any step, and gravity does not let them sag.
class DrivenRobot {
 public:
  // Puts the robot into `world` at home, hand open. `body` is the model's (RobotBody). Model and
  // world must outlive it.
  DrivenRobot(const robot::RobotModel& model, std::shared_ptr<const PreparedBody> body,
              const Eigen::Isometry3d& world_from_robot, ArticulatedWorld* world,
              const MotorOptions& options = {});

  // Moves it there at once, at rest. `arm` (J); `leader`: the gripper's first joint.
  void Place(const Eigen::VectorXd& arm, double leader);
  // What the motors hold from now on.
  void Command(const Eigen::VectorXd& arm, double leader);
  // Hands the command to the motors. Before every step of the world.
  void Drive();

  int body() const { return body_; }
  const Eigen::VectorXd& command() const { return arm_command_; }
  double leader_command() const { return leader_command_; }
  void Positions(Eigen::VectorXd* arm) const;   // (J)
  void Velocities(Eigen::VectorXd* arm) const;  // (J)
  double Leader() const;
  double Opening() const { return model_.gripper.Opening(Leader()); }  // m
  Eigen::Isometry3d Tool() const;                                      // world_from_tool

 private:
  void DriveJoint(int joint, double target, double force);
  void DriveFingers();

  const robot::RobotModel& model_;
  ArticulatedWorld& world_;
  int body_ = -1;
  double gain_ = 0.0;  // 1/s
  Eigen::VectorXd arm_command_;
  double leader_command_ = 0.0, finger_set_point_ = 0.0;
};

// What DrivenRobot puts into worlds. Throws core::Error where the URDF cannot be simulated.
std::shared_ptr<const PreparedBody> RobotBody(const robot::RobotModel& model);

}  // namespace simwright::sim
