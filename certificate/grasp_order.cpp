#include "certificate/grasp_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "manipulation/grasp_ranking.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kBin = std::numbers::pi / 8.0;  // rad of the directions that alternate
constexpr std::array kApproachShares = {0.0, 0.15, 0.35, 0.6, 1.0};  // of the standoff

}  // namespace

std::vector<size_t> OrderGrasps(const std::vector<Grasp>& grasps, const PlacedBody& target,
                                const Isometry3d& world_from_robot, double standoff,
                                RobotClearance* clearance, SearchCounts* counts) {
  const Vector3d shoulder = world_from_robot * manipulation::ShoulderPoint();
  const Vector3d reach =
      (target.world_from_body * target.model->center_of_mass - shoulder).normalized();
  Vector3d ahead = reach;
  ahead.z() = 0.0;
  ahead.normalize();
  struct Ranked {
    double cost;
    size_t index;
    std::pair<int, int> bin;
  };
  std::vector<Ranked> free;
  for (size_t i = 0; i < grasps.size(); ++i) {
    Isometry3d tool = target.world_from_body * grasps[i].body_from_tool;
    const Vector3d approach = tool.linear().col(2);
    if (!manipulation::IsApproachable(approach, ahead)) continue;
    ++counts->grasps;
    clearance->SetLeader(grasps[i].leader);
    const Vector3d origin = tool.translation();
    int hit = kFree;
    for (const double share : kApproachShares) {
      tool.translation() = origin - share * standoff * approach;
      hit = clearance->GripperHit(tool);
      if (hit != kFree) break;
    }
    if (hit != kFree) {
      ++counts->gripper_rejected;
      continue;
    }
    const double pitch = std::asin(std::clamp(-approach.z(), -1.0, 1.0));
    const double yaw =
        std::atan2(approach.dot(Vector3d::UnitZ().cross(ahead)), approach.dot(ahead));
    free.push_back(
        {manipulation::GraspCost(tool, reach, grasps[i].center_offset, grasps[i].quality),
         i,
         {static_cast<int>(std::lround(pitch / kBin)), static_cast<int>(std::lround(yaw / kBin))}});
  }
  std::stable_sort(free.begin(), free.end(),
                   [](const Ranked& a, const Ranked& b) { return a.cost < b.cost; });
  // Proved grasps come first. The n-th best of each direction come before the n+1-th best of any.
  std::map<std::tuple<bool, int, int>, int> used;
  std::vector<std::tuple<bool, int, size_t>> order;
  for (size_t k = 0; k < free.size(); ++k) {
    const bool sampled = !(grasps[free[k].index].quality > 0.0);
    const auto& [pitch, yaw] = free[k].bin;
    order.emplace_back(sampled, used[{sampled, pitch, yaw}]++, k);
  }
  std::stable_sort(order.begin(), order.end());
  std::vector<size_t> indices;
  for (const auto& [sampled, round, k] : order) indices.push_back(free[k].index);
  return indices;
}

}  // namespace simwright::certificate
