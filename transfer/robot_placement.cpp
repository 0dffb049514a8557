#include "transfer/robot_placement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tasks/layout.h"

namespace simwright::transfer {
namespace {

constexpr std::array kDistances = {0.55, 0.45, 0.65, 0.75, 0.35};  // m from the middle
constexpr std::array kDirections = {0.0, 25.0, -25.0, 50.0, -50.0, 80.0, -80.0};  // degrees
constexpr double kFromObjects = 0.25;         // m from the base's centre to an object's AABB
constexpr double kLeast = 0.25, kMost = 0.8;  // m of an object's middle from the base's centre

Eigen::AlignedBox2d Footprint(const Eigen::AlignedBox3d& box) {
  return {Eigen::Vector2d(box.min().head<2>()), Eigen::Vector2d(box.max().head<2>())};
}

bool StandsFree(const tasks::WorldModel& model, const tasks::WorldState& state,
                const Eigen::Vector2d& base) {
  for (int object = 0; object < static_cast<int>(model.objects.size()); ++object) {
    const Eigen::AlignedBox3d box = tasks::WorldAabb(model, state, object);
    if (Footprint(box).exteriorDistance(base) < kFromObjects) return false;
  }
  return true;
}

}  // namespace

int RobotPlacement::count() const {
  return static_cast<int>(std::count(reached.begin(), reached.end(), true));
}

RobotPlacement PlacementAt(const tasks::WorldModel& model, const tasks::WorldState& state,
                           const Eigen::Isometry3d& world_from_robot) {
  RobotPlacement placement;
  placement.world_from_robot = world_from_robot;
  for (int object = 0; object < static_cast<int>(model.objects.size()); ++object) {
    const Eigen::Vector3d middle = tasks::WorldAabb(model, state, object).center();
    const double distance = (middle - world_from_robot.translation()).head<2>().norm();
    placement.reached.push_back(
        distance > kLeast && distance < kMost &&
        tasks::IsPointReachable(world_from_robot, middle, -Eigen::Vector3d::UnitZ()));
  }
  return placement;
}

RobotPlacement PlaceRobot(const tasks::WorldModel& model, const tasks::WorldState& state) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (int object = 0; object < static_cast<int>(model.objects.size()); ++object) {
    middle += tasks::WorldAabb(model, state, object).center().head<2>();
  }
  middle /= std::max<double>(1.0, static_cast<double>(model.objects.size()));
  const Eigen::Vector2d to_camera =
      middle.norm() > 1e-3 ? Eigen::Vector2d(-middle.normalized()) : Eigen::Vector2d(0.0, -1.0);
  RobotPlacement best;
  int most = -1;
  for (const double direction : kDirections) {
    const Eigen::Vector2d away = Eigen::Rotation2Dd(direction * M_PI / 180.0) * to_camera;
    for (const double distance : kDistances) {
      const Eigen::Vector2d base = middle + distance * away;
      if (!StandsFree(model, state, base)) continue;
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = Eigen::AngleAxisd(std::atan2(-away.y(), -away.x()), Eigen::Vector3d::UnitZ())
                          .toRotationMatrix();
      pose.translation() << base, 0.0;
      RobotPlacement placement = PlacementAt(model, state, pose);
      if (placement.count() <= most) continue;
      most = placement.count();
      best = std::move(placement);
      if (most == static_cast<int>(model.objects.size())) return best;
    }
  }
  return most >= 0 ? best : PlacementAt(model, state, best.world_from_robot);
}

}  // namespace simwright::transfer
