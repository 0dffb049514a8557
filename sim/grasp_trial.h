#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/grasped_part.h"
#include "sim/gripper_model.h"

namespace simwright::sim {

class GraspRig;
class GraspRigSource;
struct GraspRigObject;
struct GraspRigStart;

enum class GraspEngine { kBullet, kMujoco };

// The protocol of a grasp trial: the fingers close on the object, the palm lifts it, shakes it
// along and about the three axes of the tool, one after the other, and holds it. Gravity begins
// when the fingers have closed.
//
// The part of an articulated body is neither lifted nor shaken: the fingers close on it, the palm
// follows the motion of its joint on an arc or a line, and holds. Gravity acts from the start.
struct GraspTrialOptions {
  double friction = 0.5;      // Coulomb coefficient of the pair of object and finger
  double gravity = 9.81;      // m/s^2
  double finger_speed = 0.1;  // m/s of each finger while nothing is between them
  double lift_height = 0.2;   // m
  double lift_time = 0.6;     // s
  bool shake = true;
  double shake_distance = 0.03;  // m, from the start to the far end of the motion along an axis
  double shake_angle = 0.3;      // rad, the same about an axis
  double shake_frequency = 3.0;  // Hz; one period per axis
  double hold_time = 2.0;        // s
  double joint_travel = 0.8;     // share of the joint's range along which the palm leads the part
  double joint_time = 2.0;       // s, for that
  bool release = false;          // opens the fingers at the end: the object must fall
  // The limits of a grasp that holds: the motion of the object in the gripper since the fingers
  // closed, at the tool's origin; the same while it is only held; and the depth of the gripper in
  // the object.
  double slip_limit = 0.015;         // m
  double turn_limit = 0.5;           // rad
  double creep_limit = 0.003;        // m in hold_time
  double penetration_limit = 0.005;  // m
  // The least share of its range that the joint must have reached after the hold. Tasks count a
  // joint as open from 70 % on (tasks::ObjectJoint::joint_target); a part that the palm leads to
  // 80 % and that lags by more than 5 % slides out of the fingers.
  double least_joint_share = 0.75;

  bool IsValid(std::string* error) const;
};

struct GraspTrialInput {
  // The tool before the fingers close; of a part, link_from_tool.
  Eigen::Isometry3d object_from_tool = Eigen::Isometry3d::Identity();
  double opening = 0.0;  // m between the finger pads at the start
  // The pose of a rigid object on the floor z = 0, on which it rests while the fingers close. None:
  // it floats, its z axis up, and gravity begins when the fingers have closed, as in ACRONYM
  // (Eppner et al., ICRA 2021): what a table would do does not matter then.
  std::optional<Eigen::Isometry3d> world_from_object = std::nullopt;
};

// The motion of the object in the gripper's frame during a phase.
struct GraspSlip {
  double distance = 0.0;  // m, of the point that was at the tool's origin
  double angle = 0.0;     // rad
};

struct GraspTrialResult {
  bool closed = false;    // both fingers press on the object and stand still
  bool lifted = false;    // it is still held after the lift
  bool held = false;      // and after shake and hold; a part: after the motion of its joint
  bool released = false;  // it falls when the fingers open; only with GraspTrialOptions::release
  double width = 0.0;     // m between the finger pads after closing
  GraspSlip closing;      // motion of the object while the fingers close
  // The largest since the fingers closed; of `hold`: since it began.
  GraspSlip lift, shake, joint_motion, hold;
  double joint_share = 0.0;  // of a part: the share of its joint's range after the hold
  double penetration = 0.0;  // m, the deepest of the gripper in the object
  std::string reason;        // why it does not hold, e.g. "slipped 16 mm in the shake"; or empty
};

// Grasp trials of one gripper and one object or part in one engine. Constant and thread-safe: any
// number of threads may run trials at once; each is bit-identical when repeated.
class GraspTrials {
 public:
  // Throws core::Error for an invalid gripper or invalid options, and for an object without parts
  // or mass.
  GraspTrials(GraspEngine engine, const GripperModel& gripper, const RigidBody& object,
              const GraspTrialOptions& options = {});
  // Throws core::Error for an invalid part, too.
  GraspTrials(GraspEngine engine, const GripperModel& gripper, const GraspedPart& part,
              const GraspTrialOptions& options = {});
  ~GraspTrials();
  GraspTrials(const GraspTrials&) = delete;
  GraspTrials& operator=(const GraspTrials&) = delete;

  // Stops at the first failure. Throws core::Error for an opening that the gripper does not have,
  // and for a part with `world_from_object`.
  GraspTrialResult Run(const GraspTrialInput& input) const;
  // Does the same with other times, motions and limits; `options` must have the friction and the
  // finger speed of the constructor.
  GraspTrialResult Run(const GraspTrialInput& input, const GraspTrialOptions& options) const;

 private:
  void Prepare(GraspEngine engine, const GripperModel& gripper, const GraspRigObject& object);
  GraspRigStart StartOf(const GraspTrialInput& input) const;

  double stroke_;                         // m, the range of each finger
  std::vector<Eigen::Vector3d> corners_;  // m, of the gripper, fingers open, tool frame
  GraspTrialOptions options_;
  std::optional<GraspedPart> part_;
  std::unique_ptr<const GraspRigSource> rigs_;
};

}  // namespace simwright::sim
