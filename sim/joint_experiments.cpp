#include "sim/joint_experiments.h"

#include <algorithm>
#include <cmath>

#include "assets/joint_gravity_load.h"
#include "core/progress.h"

namespace simwright::sim {
namespace {

constexpr double kSweepSeconds = 4.0;  // in each direction; a drive takes a little over one
constexpr int kLoadSamples = 16;       // over the range, for the largest gravity load

const assets::Joint& JointOf(const ArticulatedBody& body, int joint) {
  return body.joints().at(static_cast<size_t>(joint));
}

// Returns the range; one turn for a joint without limits.
double RangeOf(const assets::Joint& joint) {
  return joint.type == assets::JointType::kContinuous ? 2.0 * M_PI : joint.upper - joint.lower;
}

double LowerOf(const assets::Joint& joint) {
  return joint.type == assets::JointType::kContinuous ? 0.0 : joint.lower;
}

void ResetJoints(const ArticulatedBody& body, JointRig* rig) {
  for (const int i : body.kinematics->moving_joints()) {
    rig->Release(i);
    rig->SetPosition(i, std::max(0.0, LowerOf(JointOf(body, i))));
  }
}

}  // namespace

double GreatestLoad(const ArticulatedBody& body, int joint) {
  const assets::Joint& j = JointOf(body, joint);
  double greatest = 0.0;
  for (int i = 0; i <= kLoadSamples; ++i) {
    const double position = LowerOf(j) + RangeOf(j) * i / kLoadSamples;
    greatest =
        std::max(greatest, std::abs(assets::LoadOn(*body.kinematics, joint, position).gravity));
  }
  return greatest;
}

JointDrive DriveFor(const ArticulatedBody& body, int joint, double strongest_torque,
                    double strongest_force) {
  const assets::Joint& j = JointOf(body, joint);
  JointDrive drive;
  drive.velocity = RangeOf(j);
  const double to_speed =
      assets::LoadOn(*body.kinematics, joint, LowerOf(j)).inertia * drive.velocity / 0.25;
  // A quarter more than friction and weight: the drive slows down under load.
  drive.max_force =
      1.25 * (j.friction + GreatestLoad(body, joint)) + j.damping * drive.velocity + 2.0 * to_speed;
  const bool slides = j.type == assets::JointType::kPrismatic;
  drive.max_force = std::min(drive.max_force, slides ? strongest_force : strongest_torque);
  return drive;
}

SweepResult SweepJoint(const ArticulatedBody& body, int joint, JointRig* rig) {
  const assets::Joint& j = JointOf(body, joint);
  const JointDrive drive = DriveFor(body, joint);
  ResetJoints(body, rig);
  rig->SetPosition(joint, LowerOf(j));
  SweepResult result;
  result.lowest = result.highest = LowerOf(j);
  const double tolerance = 0.002 * RangeOf(j);
  for (const double direction : {1.0, -1.0}) {
    rig->Drive(joint, direction * drive.velocity, drive.max_force);
    const double target = direction > 0.0 ? LowerOf(j) + RangeOf(j) : LowerOf(j);
    double reached = rig->Position(joint);
    for (const double start = rig->time(); rig->time() - start < kSweepSeconds;) {
      rig->Step();
      reached = rig->Position(joint);
      if (direction > 0.0) result.highest = std::max(result.highest, reached);
      result.touching.merge(rig->Touching());
      if (direction * (target - reached) < tolerance) break;
    }
    if (direction < 0.0) result.lowest = reached;
    core::CheckCancelled();
  }
  rig->Release(joint);
  return result;
}

double DriftAfterRelease(const ArticulatedBody& body, int joint, double position, double seconds,
                         JointRig* rig) {
  ResetJoints(body, rig);
  rig->SetPosition(joint, position);
  double drift = 0.0;
  for (const double start = rig->time(); rig->time() - start < seconds;) {
    rig->Step();
    drift = std::max(drift, std::abs(rig->Position(joint) - position));
  }
  core::CheckCancelled();
  return drift;
}

double TiltWhenOpened(const ArticulatedBody& body, int joint, JointRig* rig) {
  const assets::Joint& j = JointOf(body, joint);
  JointDrive drive = DriveFor(body, joint);
  drive.velocity *= 0.5;  // slow: a hard stop at a limit jerks the whole body
  ResetJoints(body, rig);
  rig->SetRootPose(Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d start = rig->LinkPose(0);
  double tilt = 0.0;
  const auto run = [&](double seconds, bool until_open) {
    for (const double begin = rig->time(); rig->time() - begin < seconds;) {
      rig->Step();
      tilt = std::max(tilt, TiltBetween(start, rig->LinkPose(0)));
      if (until_open && rig->Position(joint) > j.upper - 0.01 * RangeOf(j)) break;
    }
  };
  run(0.25, false);  // settle first
  rig->Drive(joint, drive.velocity, drive.max_force);
  run(kSweepSeconds, true);
  rig->Release(joint);
  run(1.0, false);
  core::CheckCancelled();
  return tilt;
}

DropResult DropRig(const RigidBody& whole, const DropOptions& options, JointRig* rig) {
  const Eigen::Isometry3d start = StartPose(whole, options);
  rig->SetRootPose(start);
  DropObserver watch(whole, options, start);
  for (const double begin = rig->time();
       rig->time() - begin < options.settle_time + options.drift_time - 1e-9;) {
    rig->Step();
    watch.Observe(rig->time() - begin, rig->LinkPose(0));
  }
  core::CheckCancelled();
  return watch.Finish();
}

}  // namespace simwright::sim
