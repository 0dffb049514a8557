#include "certificate/robot_base.h"

#include <array>
#include <cmath>
#include <vector>

#include "certificate/planner.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::array kDistances = {0.40, 0.48, 0.56, 0.64};  // m in front of the furniture
constexpr double kHeightStep = 0.12;                         // m
constexpr double kMostAbove = 0.1;                           // m of the base above the furniture
constexpr std::array kShares = {0.2, 0.5, 0.8};              // of a surface's sides
constexpr std::array kLeans = {0.15, 0.5, 0.9, 1.5};         // rad of the tool below level
constexpr double kAbove = 0.05;                              // m of the tool above a surface
constexpr double kLeastSide = 0.08;                          // m of a surface
constexpr double kLeastTop = 0.005;                          // m: lower ones are floors
constexpr double kProbe = 0.02;                              // m, radius that must be free there
constexpr int kStarts = 2;

PlacedScene FixedBodies(const PlacedScene& scene) {
  PlacedScene fixed;
  for (const PlacedBody& body : scene.bodies) {
    if (body.fixed) fixed.bodies.push_back(body);
  }
  return fixed;
}

// Returns points over the surfaces of a body where nothing is, m, world.
std::vector<Vector3d> PointsOver(const PlacedBody& body, const Obstacles& obstacles) {
  std::vector<Vector3d> points;
  for (const geometry::ConvexShape& part : body.model->parts) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : part.vertices) box.extend(body.world_from_body * vertex);
    if (box.sizes().head<2>().minCoeff() < kLeastSide || box.max().z() < kLeastTop) continue;
    for (const double x : kShares) {
      for (const double y : kShares) {
        const Vector3d point(box.min().x() + x * box.sizes().x(),
                             box.min().y() + y * box.sizes().y(), box.max().z() + kAbove);
        PlacedShape probe;
        probe.Place({{point}, kProbe}, Isometry3d::Identity());
        if (obstacles.Hit(probe, 0.0) < 0) points.push_back(point);
      }
    }
  }
  return points;
}

// Returns the pose of a tool that points along +x, leaning downwards, with a level closing axis.
Isometry3d LeaningTool(const Vector3d& point, double lean) {
  Isometry3d pose = Isometry3d::Identity();
  const Vector3d approach(std::cos(lean), 0.0, -std::sin(lean));
  pose.linear().col(1) = Vector3d::UnitY();
  pose.linear().col(2) = approach;
  pose.linear().col(0) = Vector3d::UnitY().cross(approach);
  pose.translation() = point;
  return pose;
}

}  // namespace

RobotBase ChooseRobotBase(const Planner& planner, const PlacedScene& scene, int support) {
  const PlacedBody& body = scene.bodies[static_cast<size_t>(support)];
  const PlacedScene fixed = FixedBodies(scene);
  const Obstacles obstacles(fixed);
  const std::vector<Vector3d> points = PointsOver(body, obstacles);
  const Eigen::AlignedBox3d box = BoundsOf(body);
  RobotBase best;
  best.reached = -1;
  for (double height = 0.0; height <= box.max().z() + kMostAbove; height += kHeightStep) {
    for (const double distance : kDistances) {
      RobotBase base;
      base.world_from_robot.translation() =
          Vector3d(box.min().x() - distance, box.center().y(), height);
      const Isometry3d robot_from_world = base.world_from_robot.inverse();
      RobotClearance clearance(planner.shapes(), obstacles, base.world_from_robot, {});
      for (const Vector3d& point : points) {
        for (const double lean : kLeans) {
          ++base.asked;
          core::Rng rng = core::StreamRng(0, static_cast<std::uint64_t>(base.asked));
          for (const robot::JointVector& q :
               planner.Solutions(robot_from_world * LeaningTool(point, lean),
                                 planner.robot().home(), kStarts, rng)) {
            if (!clearance.IsConfigurationFree(q)) continue;
            ++base.reached;
            break;
          }
        }
      }
      if (base.reached > best.reached) best = base;
    }
  }
  return best;
}

}  // namespace simwright::certificate
