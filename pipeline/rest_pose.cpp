#include "pipeline/rest_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/stable_poses.h"
#include "sim/drop_test.h"

namespace simwright::pipeline {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kHolds = 5.0 * kDegree;   // more is a fall
constexpr double kRocks = 0.5 * kDegree;   // less is the file's own upright
constexpr double kRolling = 1e-3;          // m of drift that only a rolling body has
constexpr int kPosesTried = 6;

// The orientation without its turn about the vertical, which is free.
Eigen::Isometry3d WithoutYaw(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d up = pose.linear().transpose().col(2);  // world's up, body frame
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return turn;
}

sim::DropResult Drop(const sim::RigidBody& body, const Eigen::Isometry3d& start,
                     double settle_time) {
  sim::DropOptions options;
  options.start = start;
  options.settle_time = settle_time;
  options.watch_time = 1.0;
  return sim::DropInBullet(body, options);
}

bool Holds(const sim::DropResult& drop) {
  return drop.rests && drop.tilt < kHolds && drop.drift < kRolling;
}

// The pose itself where it hardly rocked, else the one it rocked into.
Eigen::Isometry3d Settled(const Eigen::Isometry3d& start, const sim::DropResult& drop) {
  if (drop.tilt < kRocks) return start;
  return WithoutYaw(drop.rest_pose);
}

}  // namespace

RestPose FindRestPose(const sim::RigidBody& body, const core::TriangleMesh& solid) {
  RestPose result;
  const Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  const sim::DropResult given = Drop(body, upright, 2.0);
  if (Holds(given)) {
    result.turn = Settled(upright, given);
    result.sentence = "stands the way it came";
    return result;
  }
  result.as_given = false;
  std::vector<geometry::StablePose> poses =
      geometry::StablePoses(solid, body.inertial.center_of_mass);
  if (poses.size() > kPosesTried) poses.resize(kPosesTried);
  for (const geometry::StablePose& pose : poses) {
    Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    start.linear() = pose.resting_from_body.linear();
    const sim::DropResult drop = Drop(body, start, 2.0);
    if (!Holds(drop)) continue;
    result.turn = Settled(start, drop);
    result.sentence = "does not stand the way it came; lies in its most probable stable pose that "
                      "holds (" + std::to_string(std::lround(100.0 * pose.probability)) + " %)";
    return result;
  }
  // Nothing holds: a thing that rolls, or one that rocks long. Give it time, take where it ends.
  const sim::DropResult patient = Drop(body, upright, 12.0);
  result.rolls = !patient.rests || patient.drift > kRolling ||
                 (!poses.empty() && poses[0].tipping_angle < 4.0 * kDegree);
  result.as_given = result.rolls || patient.tilt < kHolds;
  result.turn = result.rolls ? upright : WithoutYaw(patient.rest_pose);
  result.sentence = result.rolls ? "rolls: it rests in no pose of its own"
                                 : "rocks; lies where it came to rest after 12 s";
  return result;
}

}  // namespace simwright::pipeline
