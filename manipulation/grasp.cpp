#include "manipulation/grasp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;

constexpr double kNear = 0.02;                         // m
constexpr double kNearAngle = std::numbers::pi / 6.0;  // rad

double GraspDistance(const Grasp& a, const Grasp& b) {
  return (a.Center() - b.Center()).norm() / kNear +
         GraspAngle(a.object_from_tool, b.object_from_tool) / kNearAngle;
}

}  // namespace

double GraspAngle(const Isometry3d& a, const Isometry3d& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  // The half turn about z negates x and y.
  const double direct = turn.trace(), flipped = turn(2, 2) - turn(0, 0) - turn(1, 1);
  return std::acos(std::clamp(0.5 * (std::max(direct, flipped) - 1.0), -1.0, 1.0));
}

std::vector<int> FarthestGrasps(const std::vector<Grasp>& grasps, int count) {
  std::vector<int> chosen;
  std::vector<double> distance(grasps.size(), std::numeric_limits<double>::infinity());
  size_t next = 0;
  while (static_cast<int>(chosen.size()) < count && chosen.size() < grasps.size()) {
    chosen.push_back(static_cast<int>(next));
    const Grasp& last = grasps[next];
    distance[next] = -1.0;  // never again
    size_t farthest = next;
    for (size_t i = 0; i < grasps.size(); ++i) {
      if (distance[i] < 0.0) continue;
      distance[i] = std::min(distance[i], GraspDistance(grasps[i], last));
      if (distance[farthest] < distance[i]) farthest = i;
    }
    next = farthest;
  }
  return chosen;
}

double GraspCoverage(const std::vector<Grasp>& grasps, const std::vector<Grasp>& chosen) {
  if (grasps.empty()) return 0.0;
  const double cosine = std::cos(kNearAngle);
  const auto covered = std::count_if(grasps.begin(), grasps.end(), [&](const Grasp& grasp) {
    return std::any_of(chosen.begin(), chosen.end(), [&](const Grasp& other) {
      return (grasp.Center() - other.Center()).norm() <= kNear &&
             grasp.Approach().dot(other.Approach()) >= cosine;
    });
  });
  return static_cast<double>(covered) / static_cast<double>(grasps.size());
}

}  // namespace simwright::manipulation
