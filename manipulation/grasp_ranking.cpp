#include "manipulation/grasp_ranking.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSteepestUpward = 0.15;  // of an approach direction, upwards
constexpr double kAwayFromRobot = -0.2;   // least component of an approach away from the robot
constexpr double kFromAbove = 0.35;       // rad by which straight reaching is preferred
constexpr double kLevelAxis = 0.5;        // rad of cost for a vertical closing axis
constexpr double kOffsetCost = 15.0;      // rad of cost per m between grasp and centre of mass
constexpr double kQualityCost = 1.0;      // rad, for a grasp that no perturbation survives
constexpr double kUpright = 0.99;         // of the object's z axis, upwards
// The number of grasps that a planner tries: each costs up to 16 inverse kinematics solutions.
constexpr size_t kMostGrasps = 12;
constexpr double kNearPosition = 0.02;                 // m
constexpr double kNearAngle = std::numbers::pi / 6.0;  // rad

double AngleBetween(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

bool AreNear(const Grasp& a, const Grasp& b) {
  return (a.object_from_tool.translation() - b.object_from_tool.translation()).norm() <
             kNearPosition &&
         GraspAngle(a.object_from_tool, b.object_from_tool) < kNearAngle;
}

}  // namespace

double GraspCost(const Isometry3d& world_from_tool, const Vector3d& reach, double center_offset,
                 double quality) {
  const Vector3d approach = world_from_tool.linear().col(2);
  const double straight = AngleBetween(approach, reach);
  const double above = kFromAbove + AngleBetween(approach, -Vector3d::UnitZ());
  return std::min(straight, above) + kLevelAxis * std::abs(world_from_tool.linear().col(1).z()) +
         kOffsetCost * center_offset + (quality > 0.0 ? kQualityCost * (1.0 - quality) : 0.0);
}

bool IsApproachable(const Vector3d& approach, const Vector3d& ahead) {
  return approach.z() <= kSteepestUpward && approach.dot(ahead) >= kAwayFromRobot;
}

double CenterOffset(const Grasp& grasp, const Vector3d& center) {
  const Vector3d axis = (grasp.contacts[1] - grasp.contacts[0]).normalized();
  const Vector3d from_center = grasp.Center() - center;
  return (from_center - from_center.dot(axis) * axis).norm();
}

std::vector<int> RankGrasps(const Interaction& interaction, const tasks::WorldState& state) {
  const InteractionTarget& target = *interaction.target;
  if (target.grasps.empty() || target.joint >= 0 || Pushes(interaction)) return {};
  const auto object = static_cast<size_t>(target.object);
  const Isometry3d& root = state.roots[object];
  const Vector3d center = interaction.bodies[object]->body().links.front().inertial.center_of_mass;
  const Vector3d reach =
      (root * center - interaction.subtask.start.world_from_robot * ShoulderPoint()).normalized();
  Vector3d ahead = reach;
  ahead.z() = 0.0;
  ahead.normalize();
  const bool upright = root.linear()(2, 2) > kUpright;
  std::vector<std::pair<double, int>> ranked;
  for (size_t i = 0; i < target.grasps.size(); ++i) {
    const Grasp& grasp = target.grasps[i];
    if (upright && !grasp.clears_support) continue;
    const Isometry3d tool = root * grasp.object_from_tool;
    if (!IsApproachable(tool.linear().col(2), ahead)) continue;
    ranked.emplace_back(GraspCost(tool, reach, CenterOffset(grasp, center), grasp.quality),
                        static_cast<int>(i));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> chosen;
  for (const auto& [cost, index] : ranked) {
    if (chosen.size() == kMostGrasps) break;
    const Grasp& grasp = target.grasps[static_cast<size_t>(index)];
    const bool known = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
      return AreNear(grasp, target.grasps[static_cast<size_t>(other)]);
    });
    if (!known) chosen.push_back(index);
  }
  return chosen;
}

}  // namespace simwright::manipulation
