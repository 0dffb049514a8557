#include "sim/grasp_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "core/error.h"
#include "core/progress.h"
#include "sim/grasp_rig.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kFloatingHeight = 1.0;     // m
constexpr double kStillTime = 0.05;         // s in which a standing finger moves by less than
constexpr double kStillDistance = 1e-4;     // m
constexpr double kCloseTime = 1.5;          // s at most
constexpr double kPressTime = 0.1;          // s in which the force builds up and contacts settle
constexpr double kStartPenetration = 1e-3;  // m of the open gripper in the object
constexpr double kReleaseTime = 0.6;        // s
constexpr double kReleaseFall = 0.05;       // m relative to the palm
constexpr double kTrialInFloor = 1e-3;      // m
// An arm yields along the closing axis to a finger that touches a part alone: by so much (m) in
// all, as fast as the fingers while they close, and by so much (m/s) later.
constexpr double kMostYield = 0.02;
constexpr double kYieldSpeed = 0.01;
constexpr double kAddedLoad = 0.05;

std::string Formatted(const char* format, double value) {
  char text[200];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

// Returns an inertia (kg m^2 or kg) whose acceleration takes kAddedLoad of the friction and damping
// that resist the motion of a joint: negligible, and far above damping times a time step.
double NegligibleInertia(const GraspedPart& part, const GraspTrialOptions& options) {
  const assets::Joint& joint = part.body.joints()[static_cast<size_t>(part.joint)];
  const double rate = std::numbers::pi / options.joint_time;  // 1/s, of the cosine profile
  const double half = 0.5 * options.joint_travel * std::abs(part.far - part.rest);
  const double resistance = joint.friction + joint.damping * rate * half;
  return kAddedLoad * resistance / (rate * rate * half);
}

// One trial.
class TrialRun {
 public:
  // `part`: null for a rigid object.
  TrialRun(GraspRig* rig, const GraspTrialOptions& options, const GraspRigStart& start,
           double stroke, const GraspedPart* part)
      : rig_(*rig),
        options_(options),
        part_(part),
        home_(start.world_from_tool),
        tool_(start.world_from_tool),
        stroke_(stroke) {}

  GraspTrialResult Run() {
    if (part_ != nullptr) {
      result_.held = Close() && MoveJoint() && Hold() && ReachesShare();
    } else if (Close() && Lift() && Shake() && Hold()) {
      result_.held = true;
      if (options_.release) Release();
    }
    return result_;
  }

 private:
  bool Fail(std::string reason) {
    result_.reason = std::move(reason);
    return false;
  }

  void Step() {
    rig_.Step();
    if (++steps_ % 64 == 0) core::CheckCancelled();
  }

  GraspSlip SlipSince(const Isometry3d& tool_from_object) const {
    const Isometry3d now = rig_.ToolPose().inverse() * rig_.ObjectPose();
    const Isometry3d moved = now * tool_from_object.inverse();
    return {moved.translation().norm(), Eigen::AngleAxisd(moved.linear()).angle()};
  }

  static void Enlarge(const GraspSlip& slip, GraspSlip* largest) {
    largest->distance = std::max(largest->distance, slip.distance);
    largest->angle = std::max(largest->angle, slip.angle);
  }

  bool Close() {
    const Isometry3d start = rig_.ToolPose().inverse() * rig_.ObjectPose();
    std::array<double, 2> last = rig_.FingerPositions();
    std::array<bool, 2> touched = {false, false};
    const int window = static_cast<int>(std::lround(kStillTime / rig_.time_step()));
    for (bool still = false; !still;) {
      if (steps_ * rig_.time_step() > kCloseTime) {
        return Fail("the fingers do not come to rest on it");
      }
      rig_.MovePalm(Yielding(home_));
      rig_.DriveFingers(true);
      Step();
      const GraspContacts contacts = rig_.Contacts();
      if (steps_ == 1 && contacts.penetration > kStartPenetration) {
        return Fail("the open gripper is in it");
      }
      for (size_t i = 0; i < 2; ++i) touched[i] = touched[i] || contacts.fingers[i];
      Yield(contacts.fingers, options_.finger_speed);
      if (steps_ % window != 0) continue;
      const std::array<double, 2> now = rig_.FingerPositions();
      if (std::min(now[0], now[1]) > stroke_ - 1e-4) return Fail("the fingers close beside it");
      const double moved = std::max(std::abs(now[0] - last[0]), std::abs(now[1] - last[1]));
      still = moved < kStillDistance && touched[0] && touched[1];
      last = now;
      touched = {false, false};
    }
    rig_.SetGravity(options_.gravity);
    for (double time = 0.0; time < kPressTime; time += rig_.time_step()) {
      rig_.MovePalm(Yielding(home_));
      rig_.DriveFingers(true);
      Step();
      Yield(rig_.Contacts().fingers, kYieldSpeed);
    }
    result_.closing = SlipSince(start);
    result_.closed = true;
    const std::array<double, 2> positions = rig_.FingerPositions();
    result_.width = 2.0 * stroke_ - positions[0] - positions[1];
    grasped_ = rig_.ToolPose().inverse() * rig_.ObjectPose();
    return true;
  }

  // Moves the palm along the closing axis away from a finger that alone touches the part, so that
  // the other one closes: an arm yields, and a part on a fixed base does not. `speed`: m/s.
  void Yield(const std::array<bool, 2>& fingers, double speed) {
    if (part_ == nullptr || fingers[0] == fingers[1]) return;
    const double shift = (fingers[0] ? 1.0 : -1.0) * speed * rig_.time_step();
    if (std::abs(yielded_ + shift) <= kMostYield) yielded_ += shift;
  }

  Isometry3d Yielding(const Isometry3d& tool) const {
    return tool * Eigen::Translation3d(0.0, yielded_, 0.0);
  }

  // Moves the palm from where it is along `offset(share)`, which is identity at 0, in `duration`
  // (s), and records the motion of the object in `largest`. False if it is lost.
  bool Follow(const std::function<Isometry3d(double)>& offset, double duration, const char* phase,
              GraspSlip* largest) {
    const Isometry3d from = tool_;
    const auto pose = [&](double share) {
      const Isometry3d moved = offset(share);
      return Isometry3d(Eigen::Translation3d(from.translation() + moved.translation())) *
             Isometry3d(Eigen::Quaterniond(from.linear() * moved.linear()).normalized());
    };
    return FollowPoses(pose, duration, phase, largest);
  }

  // Does the same along the poses world_from_tool of `pose(share)`.
  bool FollowPoses(const std::function<Isometry3d(double)>& pose, double duration,
                   const char* phase, GraspSlip* largest) {
    const int steps = std::max(1, static_cast<int>(std::lround(duration / rig_.time_step())));
    for (int i = 1; i <= steps; ++i) {
      tool_ = pose(static_cast<double>(i) / steps);
      rig_.MovePalm(Yielding(tool_));
      rig_.DriveFingers(true);
      Step();
      Yield(rig_.Contacts().fingers, kYieldSpeed);
      if (!Check(phase, largest)) return false;
    }
    return true;
  }

  bool Check(const char* phase, GraspSlip* largest) {
    const GraspSlip slip = SlipSince(grasped_);
    Enlarge(slip, largest);
    if (!std::isfinite(slip.distance)) return Fail(std::string("unstable in the ") + phase);
    if (slip.distance > options_.slip_limit) {
      return Fail("slipped " + Formatted("%.0f mm in the ", 1e3 * slip.distance) + phase);
    }
    if (slip.angle > options_.turn_limit) {
      return Fail("turned " +
                  Formatted("%.0f degrees in the ", slip.angle * 180.0 / std::numbers::pi) + phase);
    }
    result_.penetration = std::max(result_.penetration, rig_.Contacts().penetration);
    if (result_.penetration > options_.penetration_limit) {
      return Fail(Formatted("the fingers sink in by %.1f mm", 1e3 * result_.penetration));
    }
    return true;
  }

  bool Lift() {
    const auto rise = [&](double share) {
      // Starts and ends at rest, with bounded acceleration.
      const double height = 0.5 * options_.lift_height * (1.0 - std::cos(std::numbers::pi * share));
      return Isometry3d(Eigen::Translation3d(0.0, 0.0, height));
    };
    result_.lifted = Follow(rise, options_.lift_time, "lift", &result_.lift);
    return result_.lifted;
  }

  bool Shake() {
    if (!options_.shake) return true;
    for (int i = 0; i < 6; ++i) {
      const Vector3d axis = Vector3d::Unit(i % 3);
      const auto swing = [&](double share) -> Isometry3d {
        const double size = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * share));
        if (i >= 3) return Isometry3d(Eigen::AngleAxisd(size * options_.shake_angle, axis));
        return Isometry3d(
            Eigen::Translation3d(tool_axes() * axis * (size * options_.shake_distance)));
      };
      if (!Follow(swing, 1.0 / options_.shake_frequency, "shake", &result_.shake)) return false;
    }
    return true;
  }

  // Leads the part along the motion of its joint, from where it is.
  bool MoveJoint() {
    const assets::Joint& joint = part_->body.joints()[static_cast<size_t>(part_->joint)];
    const std::vector<Isometry3d> poses =
        part_->body.kinematics->LinkPoses(part_->PositionsAt(0.0));
    const Isometry3d& world_from_zero = poses[static_cast<size_t>(part_->joint) + 1];
    const double from = rig_.JointPosition();
    const double to = part_->rest + options_.joint_travel * (part_->far - part_->rest);
    const Isometry3d carried =
        (world_from_zero * assets::JointMotion(joint, from)).inverse() * tool_;
    const auto pose = [&](double share) -> Isometry3d {
      // Starts and ends at rest, with bounded acceleration.
      const double position = from + 0.5 * (to - from) * (1.0 - std::cos(std::numbers::pi * share));
      Isometry3d tool = world_from_zero * assets::JointMotion(joint, position) * carried;
      tool.linear() = Eigen::Quaterniond(tool.linear()).normalized().toRotationMatrix();
      return tool;
    };
    return FollowPoses(pose, options_.joint_time, "motion of the joint", &result_.joint_motion);
  }

  bool ReachesShare() {
    result_.joint_share = (rig_.JointPosition() - part_->rest) / (part_->far - part_->rest);
    if (result_.joint_share >= options_.least_joint_share) return true;
    return Fail(Formatted("moves the joint too little: %.0f %%", 100.0 * result_.joint_share));
  }

  bool Hold() {
    const Isometry3d start = rig_.ToolPose().inverse() * rig_.ObjectPose();
    GraspSlip since_closing;
    const auto stand = [](double) { return Isometry3d::Identity(); };
    if (!Follow(stand, options_.hold_time, "hold", &since_closing)) return false;
    result_.hold = SlipSince(start);
    if (result_.hold.distance > options_.creep_limit) {
      return Fail(Formatted("creeps %.1f mm while held", 1e3 * result_.hold.distance));
    }
    const GraspContacts contacts = rig_.Contacts();
    if (!contacts.fingers[0] || !contacts.fingers[1]) return Fail("a finger lost it");
    return true;
  }

  void Release() {
    for (double time = 0.0; time < kReleaseTime && !result_.released; time += rig_.time_step()) {
      rig_.MovePalm(tool_);
      rig_.DriveFingers(false);
      Step();
      const Isometry3d start = rig_.ToolPose() * grasped_;
      result_.released =
          start.translation().z() - rig_.ObjectPose().translation().z() > kReleaseFall;
    }
    if (!result_.released) result_.reason = "does not fall when the fingers open";
  }

  Eigen::Matrix3d tool_axes() const { return home_.linear(); }

  GraspRig& rig_;
  const GraspTrialOptions& options_;
  const GraspedPart* part_;
  Isometry3d home_, tool_;  // world_from_tool: at the grasp, and commanded now
  double stroke_;
  Isometry3d grasped_ = Isometry3d::Identity();  // tool_from_object after closing
  int steps_ = 0;
  double yielded_ = 0.0;  // m, of the palm along the closing axis
  GraspTrialResult result_;
};

}  // namespace

bool GraspTrialOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (!(friction >= 0.0) || friction > 10.0) return fail("friction must be 0 to 10");
  if (!(gravity >= 0.0) || gravity > 100.0) return fail("gravity must be 0 to 100 m/s^2");
  if (!(finger_speed > 0.0) || finger_speed > 1.0) return fail("finger_speed must be 0 to 1 m/s");
  if (!(lift_height >= 0.0) || lift_height > 2.0) return fail("lift_height must be 0 to 2 m");
  if (!(lift_time > 0.0) || lift_time > 60.0) return fail("lift_time must be 0 to 60 s");
  if (!(hold_time >= 0.0) || hold_time > 60.0) return fail("hold_time must be 0 to 60 s");
  if (!(shake_frequency > 0.0) || shake_frequency > 20.0) {
    return fail("shake_frequency must be 0 to 20 Hz");
  }
  if (!(std::abs(shake_distance) <= 0.5) || !(std::abs(shake_angle) <= 1.5)) {
    return fail("shake_distance must be at most 0.5 m and shake_angle 1.5 rad");
  }
  if (!(slip_limit > 0.0 && turn_limit > 0.0 && creep_limit > 0.0 && penetration_limit > 0.0)) {
    return fail("the limits must be positive");
  }
  if (!(joint_time > 0.0) || joint_time > 60.0) return fail("joint_time must be 0 to 60 s");
  if (!(joint_travel > 0.0) || joint_travel > 1.0) return fail("joint_travel must be 0 to 1");
  if (!(least_joint_share >= 0.0) || least_joint_share > joint_travel) {
    return fail("least_joint_share must be 0 to joint_travel");
  }
  return true;
}

GraspRigObject::GraspRigObject(const RigidBody& rigid)
    : body(ArticulatedBodyFrom(rigid)), held({true}), moved_mass(rigid.inertial.mass) {
  if (rigid.parts.empty() || !(rigid.inertial.mass > 0.0)) {
    throw core::Error("an object needs collision parts and a mass", rigid.name);
  }
}

GraspRigObject::GraspRigObject(const GraspedPart& part)
    : body(part.body), fixed(true), link(part.link), joint(part.joint) {
  std::string error;
  if (!part.IsValid(&error)) {
    throw core::Error("grasp trial: " + error, body.kinematics ? body.name() : "");
  }
  held = part.Held();
  positions = part.PositionsAt(part.rest);
  moved_mass = part.MovedMass();
}

GraspTrials::GraspTrials(GraspEngine engine, const GripperModel& gripper, const RigidBody& object,
                         const GraspTrialOptions& options)
    : stroke_(0.5 * gripper.max_opening), options_(options) {
  Prepare(engine, gripper, GraspRigObject(object));
}

GraspTrials::GraspTrials(GraspEngine engine, const GripperModel& gripper, const GraspedPart& part,
                         const GraspTrialOptions& options)
    : stroke_(0.5 * gripper.max_opening), options_(options), part_(part) {
  GraspRigObject object(part);
  object.added_inertia = NegligibleInertia(part, options);
  Prepare(engine, gripper, object);
}

GraspTrials::~GraspTrials() = default;

void GraspTrials::Prepare(GraspEngine engine, const GripperModel& gripper,
                          const GraspRigObject& object) {
  std::string error;
  if (!options_.IsValid(&error)) throw core::Error("grasp trial: " + error);
  const GraspRigOptions rig{.friction = options_.friction, .finger_speed = options_.finger_speed};
  rigs_ = engine == GraspEngine::kBullet ? BulletGraspRigs(gripper, object, rig)
                                         : MujocoGraspRigs(gripper, object, rig);
  for (const auto* parts : {&gripper.palm, &gripper.fingers[0], &gripper.fingers[1]}) {
    for (const core::TriangleMesh& part : *parts) {
      corners_.insert(corners_.end(), part.vertices.begin(), part.vertices.end());
    }
  }
}

GraspRigStart GraspTrials::StartOf(const GraspTrialInput& input) const {
  if (!(input.opening >= 0.0) || input.opening > 2.0 * stroke_ + 1e-9) {
    throw core::Error("grasp trial: the opening must be 0 to " +
                      Formatted("%.0f mm", 2e3 * stroke_));
  }
  if (part_ && input.world_from_object) {
    throw core::Error("grasp trial: a part has no pose on the floor", part_->body.name());
  }
  GraspRigStart start;
  start.closing = std::max(0.0, stroke_ - 0.5 * input.opening);
  if (part_) {
    const std::vector<Isometry3d> poses =
        part_->body.kinematics->LinkPoses(part_->PositionsAt(part_->rest));
    start.world_from_tool = poses[static_cast<size_t>(part_->link)] * input.object_from_tool;
    return start;
  }
  start.floor = input.world_from_object.has_value();
  start.world_from_object =
      input.world_from_object.value_or(Isometry3d(Eigen::Translation3d(0, 0, kFloatingHeight)));
  start.world_from_tool = start.world_from_object * input.object_from_tool;
  return start;
}

GraspTrialResult GraspTrials::Run(const GraspTrialInput& input) const {
  return Run(input, options_);
}

GraspTrialResult GraspTrials::Run(const GraspTrialInput& input,
                                  const GraspTrialOptions& options) const {
  const GraspRigStart start = StartOf(input);
  if (start.floor) {
    double lowest = HUGE_VAL;
    for (const Vector3d& corner : corners_) {
      lowest = std::min(lowest, (start.world_from_tool * corner).z());
    }
    if (lowest < -kTrialInFloor) {
      GraspTrialResult result;
      result.reason = "the gripper is in the floor";
      return result;
    }
  }
  const std::unique_ptr<GraspRig> rig = rigs_->Make(start);
  if (start.floor || part_) rig->SetGravity(options.gravity);
  return TrialRun(rig.get(), options, start, stroke_, part_ ? &*part_ : nullptr).Run();
}

}  // namespace simwright::sim
