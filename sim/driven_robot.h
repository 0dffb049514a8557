#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.h"
#include "sim/articulated_world.h"

namespace simwright::sim {

struct MotorOptions {
  // The share of a position error that a motor corrects in one step. Near 1 a hard impact
  // oscillates.
  double stiffness = 0.3;
  // The share of the grip force that keeps the fingers symmetric. A real arm yields until both
  // fingers press on the object; this one is stiff, so the gripper yields instead: with 1 or more,
  // a single finger presses on a handle that is a millimetre off the middle and slides off it.
  double centring = 0.9;
  // The friction coefficient of the finger surfaces; none: the URDF's.
  std::optional<double> finger_friction = std::nullopt;
};

// A robot in a world. A motor holds each joint at its commanded position within the joint's effort
// and velocity limits, the fingers with the grip force. The motors are implicit: they are solved
// together with the contacts, are stable at any time step, and do not sag under gravity.
class DrivenRobot {
 public:
  // Adds the robot to `world` at home, gripper open. `body` is the model's (RobotBody). Model and
  // world must outlive it.
  DrivenRobot(const robot::RobotModel& model, std::shared_ptr<const PreparedBody> body,
              const Eigen::Isometry3d& world_from_robot, ArticulatedWorld* world,
              const MotorOptions& options = {});

  // Teleports the robot to a configuration, at rest. `arm` (J); `leader`: the gripper's first
  // joint.
  void Place(const Eigen::VectorXd& arm, double leader);
  // Sets the position targets of the motors.
  void Command(const Eigen::VectorXd& arm, double leader);
  // Applies the targets to the motors. Call it before every step of the world.
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

// Returns the links that DrivenRobot does not let touch the floor: those that are in it at zero.
// Published collision shapes are generous, and the floor would brake the first joint.
std::vector<int> LinksInFloor(const ArticulatedBody& body, const robot::RobotModel& model,
                              const Eigen::Isometry3d& world_from_robot);

// Returns the body of DrivenRobot. Throws core::Error if the URDF cannot be simulated.
std::shared_ptr<const PreparedBody> RobotBody(const robot::RobotModel& model);

}  // namespace simwright::sim
