#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "sim/articulated_body.h"
#include "sim/grasped_part.h"
#include "sim/gripper_model.h"

namespace simwright::sim {

// The settings of the two bodies of a grasp trial.
struct GraspRigOptions {
  double friction = 0.5;      // of the object against fingers, palm and floor
  double finger_speed = 0.1;  // m/s of each finger while nothing is between them
};

// The object of a grasp trial: a free rigid body, or an articulated body whose root is fixed.
struct GraspRigObject {
  explicit GraspRigObject(const RigidBody& rigid);
  explicit GraspRigObject(const GraspedPart& part);

  ArticulatedBody body;
  bool fixed = false;      // the root stays at world_from_object, and no link meets the floor
  int link = 0;            // that the fingers hold
  int joint = -1;          // that moves it; -1: none
  std::vector<bool> held;  // by link: rigidly joined to `link`
  std::vector<double> positions;  // rad or m, by joint, at the start
  double moved_mass = 0.0;        // kg
  // kg m^2 or kg, added to what the joint moves, in MuJoCo alone: its integrator takes a joint's
  // damping b implicitly, but its solver does not, so that contact friction accelerates an inertia
  // I << b dt too little, and a light knob lags behind the fingers.
  double added_inertia = 0.0;
};

// The state at the start of a trial. All velocities are zero, and there is no gravity.
struct GraspRigStart {
  Eigen::Isometry3d world_from_tool = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  double closing = 0.0;  // m, position of both finger joints
  bool floor = false;    // the object collides with the floor z = 0; the gripper never does
};

// The contacts of the object after a step.
struct GraspContacts {
  std::array<bool, 2> fingers = {false, false};  // true: the finger touches a held link
  bool palm = false;
  double penetration = 0.0;  // m, the deepest of the gripper in any link
};

// A gripper that moves along a given path regardless of loads, with fingers of limited force, and
// an object, in a physics engine. One thread per rig.
class GraspRig {
 public:
  virtual ~GraspRig() = default;

  // Sets gravity (m/s^2, along -z) from the next step on.
  virtual void SetGravity(double gravity) = 0;
  // Moves the palm during the next step so that the tool frame ends at `world_from_tool`.
  virtual void MovePalm(const Eigen::Isometry3d& world_from_tool) = 0;
  // Closes the fingers, or opens them, with the gripper's force.
  virtual void DriveFingers(bool close) = 0;
  virtual void Step() = 0;

  virtual double time_step() const = 0;                       // s
  virtual Eigen::Isometry3d ToolPose() const = 0;             // world_from_tool
  virtual Eigen::Isometry3d ObjectPose() const = 0;           // world_from_link of the held link
  virtual double JointPosition() const = 0;                   // rad or m; 0 without a joint
  virtual std::array<double, 2> FingerPositions() const = 0;  // m, of the joints
  virtual GraspContacts Contacts() const = 0;
};

// The shapes of a gripper and an object, prepared for an engine. Constant; rigs of any number of
// threads share it and must not outlive it.
class GraspRigSource {
 public:
  virtual ~GraspRigSource() = default;
  virtual std::unique_ptr<GraspRig> Make(const GraspRigStart& start) const = 0;
};

// Throw core::Error for an invalid gripper, and for an object that the engine rejects. A fixed
// object must start at world_from_object = identity.
std::unique_ptr<GraspRigSource> BulletGraspRigs(const GripperModel& gripper,
                                                const GraspRigObject& object,
                                                const GraspRigOptions& options);
std::unique_ptr<GraspRigSource> MujocoGraspRigs(const GripperModel& gripper,
                                                const GraspRigObject& object,
                                                const GraspRigOptions& options);

}  // namespace simwright::sim
