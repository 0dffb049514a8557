#include "sim/drop_test.h"

#include <algorithm>
#include <cmath>

#include "core/progress.h"
#include "sim/world.h"

namespace simwright::sim {

double TiltBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  // The world's vertical in the body frame, in both poses.
  const Eigen::Vector3d up_a = a.linear().transpose().col(2);
  const Eigen::Vector3d up_b = b.linear().transpose().col(2);
  return std::atan2(up_a.cross(up_b).norm(), up_a.dot(up_b));
}

Eigen::Isometry3d StartPose(const RigidBody& body, const DropOptions& options) {
  Eigen::Isometry3d pose = options.start;
  const Eigen::Vector3d center = pose * body.inertial.center_of_mass;
  pose.pretranslate(Eigen::Vector3d(-center.x(), -center.y(), 0.0));
  pose.pretranslate(Eigen::Vector3d(0.0, 0.0, options.height - LowestPoint(body, pose)));
  return pose;
}

DropObserver::DropObserver(const RigidBody& body, const DropOptions& options,
                           const Eigen::Isometry3d& start)
    : body_(body),
      options_(options),
      start_(start),
      radius_(Radius(body)),
      anchor_(start),
      half_(start) {}

void DropObserver::Observe(double time, const Eigen::Isometry3d& world_from_body) {
  if (time <= options_.settle_time + 1e-9) {
    const Eigen::Vector3d moved =
        world_from_body * body_.inertial.center_of_mass - anchor_ * body_.inertial.center_of_mass;
    const Eigen::AngleAxisd turned(anchor_.linear().transpose() * world_from_body.linear());
    // An upper bound of the displacement of any point.
    const double farthest = moved.norm() + radius_ * std::abs(turned.angle());
    const bool left = farthest > options_.rest_speed * options_.rest_window;
    if (left) result_.rest_time = time;
    if (left || time - anchor_time_ >= options_.rest_window) {
      anchor_ = world_from_body;
      anchor_time_ = time;
    }
    result_.rest_pose = world_from_body;
    result_.rests = time - result_.rest_time >= options_.rest_window;
  }
  const double height = (world_from_body * body_.inertial.center_of_mass).z();
  highest_ = time <= options_.settle_time + 1e-9 ? height : std::max(highest_, height);
  result_.fall = std::max(result_.fall, highest_ - height);
  if (time <= options_.settle_time + 0.5 * options_.drift_time + 1e-9) half_ = world_from_body;
  result_.final_pose = world_from_body;
}

DropResult DropObserver::Finish() const {
  DropResult result = result_;
  result.tilt = TiltBetween(start_, result.rest_pose);
  const auto distance = [&](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a * body_.inertial.center_of_mass - b * body_.inertial.center_of_mass).norm();
  };
  result.drift = distance(result.final_pose, result.rest_pose);
  result.early_drift = distance(half_, result.rest_pose);
  result.late_drift = distance(result.final_pose, half_);
  result.turn =
      Eigen::AngleAxisd(result.rest_pose.linear().transpose() * result.final_pose.linear()).angle();
  result.lowest_point = LowestPoint(body_, result.final_pose);
  return result;
}

DropResult DropInBullet(const RigidBody& body, const DropOptions& options) {
  World world;
  const Eigen::Isometry3d start = StartPose(body, options);
  const int index = world.Add(body, start);
  DropObserver watch(body, options, start);
  while (world.time() < options.settle_time + options.drift_time - 1e-9) {
    world.Step();
    watch.Observe(world.time(), world.Pose(index));
  }
  core::CheckCancelled();
  return watch.Finish();
}

}  // namespace simwright::sim
