#include "manipulation/level_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "manipulation/tool_path.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kTiltSamples = 12;                            // of each segment of a path
constexpr double kRises[] = {0.0, 0.1, 0.2, 0.3, 0.45};     // m above the higher end
constexpr double kRadiusShares[] = {1.0, 0.75, 0.6, 0.45};  // of the larger distance from the axis
constexpr double kStep = 0.2;                               // m between poses
constexpr double kTurnStep = 0.4;                           // rad about the robot's axis
constexpr double kSameTurn = 0.1;                           // rad
constexpr double kSamePlace = 0.02;                         // m

// Poses (world_from_tool) from a beginning to an end, in cylindrical coordinates about the vertical
// through the robot's base.
class CylindricalPath {
 public:
  CylindricalPath(const Vector3d& base, const Isometry3d& begin, const Isometry3d& end)
      : base_(base),
        begin_(begin),
        end_(end),
        turned_from_(begin.linear()),
        turned_to_(end.linear()) {
    const Vector3d a = begin.translation() - base, b = end.translation() - base;
    radius_ = {a.head<2>().norm(), b.head<2>().norm()};
    from_ = std::atan2(a.y(), a.x());
    angle_ = std::remainder(std::atan2(b.y(), b.x()) - from_, 2.0 * M_PI);
    height_ = std::max(a.z(), b.z());
  }

  // Returns the poses after the beginning: `rise` (m) above the higher end and nowhere between the
  // ends farther from the axis than `share` of the larger radius.
  std::vector<Isometry3d> Poses(double rise, double share) const {
    const double most = share * std::max(radius_[0], radius_[1]), height = height_ + rise;
    const double a = std::min(radius_[0], most), b = std::min(radius_[1], most);
    const double length = std::abs(angle_) * 0.5 * (a + b) + std::abs(a - b);
    const double turn = std::max(std::abs(angle_), turned_from_.angularDistance(turned_to_));
    const int steps = 1 + static_cast<int>(std::max(length / kStep, turn / kTurnStep));
    std::vector<Isometry3d> poses{begin_, At(radius_[0], 0.0, height)};
    for (int i = 0; i <= steps; ++i) {
      const double passed = static_cast<double>(i) / steps;
      poses.push_back(At(a + passed * (b - a), passed, height));
    }
    poses.push_back(At(radius_[1], 1.0, height));
    poses.push_back(end_);
    // Leaves out poses beside the one before, but not the end.
    const auto same = [](const Isometry3d& one, const Isometry3d& other) {
      return (one.translation() - other.translation()).norm() < kSamePlace &&
             Eigen::Quaterniond(one.linear()).angularDistance(Eigen::Quaterniond(other.linear())) <
                 kSameTurn;
    };
    std::reverse(poses.begin(), poses.end());
    poses.erase(std::unique(poses.begin(), poses.end(), same), poses.end());
    std::reverse(poses.begin(), poses.end());
    if (poses.size() > 1) poses.erase(poses.begin());
    return poses;
  }

 private:
  // `passed`: the share of the angle about the axis.
  Isometry3d At(double radius, double passed, double height) const {
    const double angle = from_ + passed * angle_;
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() =
        base_ + Vector3d(radius * std::cos(angle), radius * std::sin(angle), height);
    pose.linear() = turned_from_.slerp(passed, turned_to_).toRotationMatrix();
    return pose;
  }

  Vector3d base_;
  Isometry3d begin_, end_;
  Eigen::Quaterniond turned_from_, turned_to_;
  std::array<double, 2> radius_;     // m, of both ends
  double from_ = 0.0, angle_ = 0.0;  // rad
  double height_ = 0.0;              // m, of the higher end above the base
};

// Returns configurations (J) that follow `poses` from `from` without collision, as far as possible.
JointPath Follow(const PlanningArm& context, const Interaction& interaction,
                 const CollisionChecker& clearance, const robot::JointVector& from,
                 const std::vector<Isometry3d>& poses) {
  CartesianFollower follower(context, interaction, from);
  JointPath path;
  for (const Isometry3d& pose : poses) {
    const robot::JointVector before = follower.configuration();
    if (!follower.MoveTo(pose)) break;
    if (!clearance.IsPathCollisionFree(before, follower.configuration())) break;
    path.push_back(follower.configuration());
  }
  return path;
}

}  // namespace

double LargestTilt(const PlanningArm& context, const Interaction& interaction,
                   const robot::JointVector& from, const JointPath& path) {
  const Vector3d up_in_base =
      interaction.subtask.start.world_from_robot.linear().transpose() * Vector3d::UnitZ();
  const auto up_at = [&](const robot::JointVector& at) -> Vector3d {
    return robot::ForwardKinematics(context.robot->arm, at).linear().transpose() * up_in_base;
  };
  const Vector3d up = up_at(from);  // in the tool's frame
  robot::JointVector before = from;
  double least = 1.0;  // cosine
  for (const robot::JointVector& next : path) {
    for (int i = 1; i <= kTiltSamples; ++i) {
      const double share = static_cast<double>(i) / kTiltSamples;
      least = std::min(least, up.dot(up_at(before + share * (next - before))));
    }
    before = next;
  }
  return std::acos(std::clamp(least, -1.0, 1.0));
}

std::optional<JointPath> PlanLevelPath(const PlanningArm& context, const Interaction& interaction,
                                       const CollisionChecker& clearance,
                                       const robot::JointVector& from, const LevelGoal& goal) {
  const Isometry3d& world_from_base = interaction.subtask.start.world_from_robot;
  const Isometry3d begin = world_from_base * robot::ForwardKinematics(context.robot->arm, from);
  const CylindricalPath cylindrical(world_from_base.translation(), begin, goal.world_from_tool);
  std::optional<JointPath> joined;
  double least = kLevelTilt;  // rad, of `joined`
  for (const double share : kRadiusShares) {
    for (const double rise : kRises) {
      const std::vector<Isometry3d> poses = cylindrical.Poses(rise, share);
      JointPath path = Follow(context, interaction, clearance, from, poses);
      if (path.size() == poses.size() && goal.is_suitable(path.back()) &&
          LargestTilt(context, interaction, from, path) <= kLevelTilt) {
        return path;
      }
      const robot::JointVector last = path.empty() ? from : path.back();
      path.emplace_back();
      for (const robot::JointVector& end : goal.configurations) {
        path.back() = end;
        const double tilt = LargestTilt(context, interaction, from, path);
        if (tilt >= least || !clearance.IsPathCollisionFree(last, end)) continue;
        least = tilt;
        joined = path;
      }
    }
  }
  return joined;
}

}  // namespace simwright::manipulation
