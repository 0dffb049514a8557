#include "asset_build/rest_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/convex_hull.h"
#include "geometry/stable_poses.h"
#include "sim/drop_test.h"

namespace simwright::asset_build {
namespace {

constexpr double kRestDegree = std::numbers::pi / 180.0;
constexpr double kHolds = 5.0 * kRestDegree;  // a larger tilt is a fall
constexpr double kRocks = 0.5 * kRestDegree;  // a smaller tilt is the file's own upright pose
constexpr double kRolling = 0.7e-3;           // m of drift in 2 s; the check allows 1 mm
constexpr double kNearUpright = 20.0 * kRestDegree;
constexpr double kFirmRest = 4.0 * kRestDegree;
constexpr int kPosesTried = 8;
constexpr double kLeastTipping =
    0.5 * kRestDegree;  // a smaller angle is balancing on an edge or a tip

// Returns the orientation without its rotation about the vertical, which is arbitrary.
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
  options.drift_time = 2.0;
  return sim::DropInBullet(body, options);
}

bool Holds(const sim::DropResult& drop) {
  return drop.rests && drop.tilt < kHolds && drop.drift < kRolling;
}

// Returns the start pose if the body hardly rocked, else the pose it rocked into.
Eigen::Isometry3d Settled(const Eigen::Isometry3d& start, const sim::DropResult& drop) {
  if (drop.tilt < kRocks) return start;
  return WithoutYaw(drop.rest_pose);
}

// Returns the shape that the engines simulate: the hull of all parts, whose facets are the faces
// the body can lie on.
core::TriangleMesh HullOfParts(const sim::RigidBody& body) {
  std::vector<Eigen::Vector3d> points;
  for (const core::TriangleMesh& part : body.parts) {
    points.insert(points.end(), part.vertices.begin(), part.vertices.end());
  }
  return geometry::ConvexHull(points);
}

// Returns true if the support polygon withstands some tilt. Points that are higher by less than the
// body rocks belong to it.
bool Bears(const sim::RigidBody& body, const Eigen::Isometry3d& turn) {
  const core::TriangleMesh hull = HullOfParts(body);
  const double slack = std::sin(kRocks) * core::Bounds(hull).diagonal().norm();
  const Eigen::Vector3d down = -turn.linear().row(2).transpose();
  return geometry::TippingAngle(hull, body.inertial.center_of_mass, down, slack) > kLeastTipping;
}

// Returns the candidate poses: first those near the given one (a fruit that lay slightly tilted),
// then by probability.
std::vector<geometry::StablePose> PosesToTry(const sim::RigidBody& body) {
  std::vector<geometry::StablePose> poses =
      geometry::StablePoses(HullOfParts(body), body.inertial.center_of_mass);
  const auto tilt = [](const geometry::StablePose& pose) {
    return sim::TiltBetween(pose.resting_from_body, Eigen::Isometry3d::Identity());
  };
  const auto far = std::stable_partition(
      poses.begin(), poses.end(), [&](const auto& pose) { return tilt(pose) < kNearUpright; });
  // Among the near poses, those that withstand some tilt come first: both engines agree on them.
  std::stable_sort(poses.begin(), far, [&](const auto& a, const auto& b) {
    const bool firm_a = a.tipping_angle > kFirmRest, firm_b = b.tipping_angle > kFirmRest;
    return firm_a != firm_b ? firm_a : tilt(a) < tilt(b);
  });
  if (poses.size() > kPosesTried) poses.resize(kPosesTried);
  return poses;
}

}  // namespace

bool RollsInPose(const sim::RigidBody& body, const core::TriangleMesh& solid,
                 const Eigen::Isometry3d& turn) {
  const Eigen::Vector3d& center = body.inertial.center_of_mass;
  const Eigen::Vector3d down = -turn.linear().row(2).transpose();
  return geometry::Rolls(solid, center, down) || geometry::Rolls(HullOfParts(body), center, down);
}

RestPose FindRestPose(const sim::RigidBody& body, const core::TriangleMesh& solid) {
  const Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  const auto rolls = [&](const Eigen::Isometry3d& turn) { return RollsInPose(body, solid, turn); };
  const sim::DropResult given = Drop(body, upright, 2.0);
  const Eigen::Isometry3d settled = Settled(upright, given);
  // A symmetric body may balance on an edge in one engine and tip in the other.
  if (Holds(given) && (Bears(body, settled) || rolls(settled))) {
    return {settled, rolls(settled), true};
  }
  const std::vector<geometry::StablePose> poses = PosesToTry(body);
  for (const geometry::StablePose& pose : poses) {
    Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    start.linear() = pose.resting_from_body.linear();
    // A lying bottle is not stood up because it rolls.
    if (IsUprightAsGiven(start) && rolls(start)) return {start, true, false};
    const sim::DropResult drop = Drop(body, start, 2.0);
    if (!Holds(drop)) continue;
    const Eigen::Isometry3d turn = Settled(start, drop);
    return {turn, rolls(turn), true};
  }
  // No pose holds immediately: simulate longer and use the final pose.
  const sim::DropResult patient = Drop(body, upright, 15.0);
  const Eigen::Isometry3d turn = WithoutYaw(patient.rest_pose);
  const bool held = Holds(Drop(body, turn, 2.0));
  return {turn, !held || rolls(turn), held};
}

RestPose FindRestPose(const sim::RigidBody& body) {
  return FindRestPose(body, HullOfParts(body));
}

bool IsUprightAsGiven(const Eigen::Isometry3d& turn) {
  return sim::TiltBetween(turn, Eigen::Isometry3d::Identity()) < kNearUpright;
}

std::string RestSentence(const Eigen::Isometry3d& turn, bool rolls) {
  const double tilt = sim::TiltBetween(turn, Eigen::Isometry3d::Identity());
  const std::string degrees = std::to_string(std::lround(tilt / kRestDegree)) + " degrees";
  if (rolls) {
    return "rolls" +
           (tilt < kRocks ? ", and keeps its given pose" : ", and lies rotated by " + degrees);
  }
  if (tilt < kRocks) return "stands in its given pose";
  return (IsUprightAsGiven(turn)
              ? "stands nearly in its given pose, rotated by "
              : "does not stand in its given pose; lies in a stable pose, rotated by ") +
         degrees;
}

}  // namespace simwright::asset_build
