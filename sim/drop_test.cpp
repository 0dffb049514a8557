#include "sim/drop_test.h"

#include <algorithm>
#include <cmath>

#include "core/progress.h"
#include "sim/world.h"

namespace simwright::sim {

double TiltBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  // World's vertical seen from the body, in both poses.
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

DropWatch::DropWatch(const RigidBody& body, const DropOptions& options,
                     const Eigen::Isometry3d& start)
    : body_(body), options_(options), start_(start) {}

void DropWatch::Observe(double time, const Eigen::Isometry3d& world_from_body, double speed) {
  if (time <= options_.settle_time + 1e-9) {
    if (speed > options_.rest_speed) result_.rest_time = time;
    result_.rest_pose = world_from_body;
    result_.rests = speed <= options_.rest_speed;
  }
  result_.final_pose = world_from_body;
}

DropResult DropWatch::Finish() const {
  DropResult result = result_;
  result.tilt = TiltBetween(start_, result.rest_pose);
  result.drift = (result.final_pose * body_.inertial.center_of_mass -
                  result.rest_pose * body_.inertial.center_of_mass)
                     .norm();
  result.turn =
      Eigen::AngleAxisd(result.rest_pose.linear().transpose() * result.final_pose.linear()).angle();
  result.lowest_point = LowestPoint(body_, result.final_pose);
  return result;
}

DropResult DropInBullet(const RigidBody& body, const DropOptions& options) {
  World world;
  const Eigen::Isometry3d start = StartPose(body, options);
  const int index = world.Add(body, start);
  const double radius = Radius(body);
  DropWatch watch(body, options, start);
  while (world.time() < options.settle_time + options.watch_time - 1e-9) {
    world.Step();
    // The fastest point of the body moves at no more than this.
    const double speed =
        world.LinearVelocity(index).norm() + radius * world.AngularVelocity(index).norm();
    watch.Observe(world.time(), world.Pose(index), speed);
  }
  core::CheckCancelled();
  return watch.Finish();
}

}  // namespace simwright::sim
