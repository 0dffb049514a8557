#include "manipulation/collision_checker.h"

#include <algorithm>

#include "manipulation/gripper_penetration.h"

namespace simwright::manipulation {
namespace {

constexpr double kPenetration = 0.001;  // m; a board's points are at most half its thickness deep
constexpr double kFloorDepth = 0.005;   // m
constexpr double kCheckStep = 0.05;     // rad or m of any joint between checks
constexpr double kNearEnd = 0.3;        // rad or m of any joint from an exempt end

// Returns world_from_link of the robot's links. (urdf.links)
std::vector<Eigen::Isometry3d> RobotPoses(const robot::RobotModel& robot,
                                          const Eigen::Isometry3d& world_from_robot,
                                          const robot::JointVector& arm) {
  std::vector<Eigen::Isometry3d> poses = robot.LinkPoses(arm, robot.gripper.open);
  for (Eigen::Isometry3d& pose : poses) pose = world_from_robot * pose;
  return poses;
}

bool IntersectsFloor(const SurfacePoints& surface, const Eigen::Isometry3d& world_from_surface) {
  if ((world_from_surface * surface.center).z() > surface.radius) return false;
  for (const Eigen::Vector3d& point : surface.points) {
    if ((world_from_surface * point).z() < -kFloorDepth) return true;
  }
  return false;
}

// Returns the solids with every face offset outwards by `margin` (m).
BodyParts Inflated(BodyParts solids, double margin) {
  for (std::vector<ConvexPart>& link : solids) {
    for (ConvexPart& solid : link) {
      const Eigen::Vector3d low = solid.box.min().array() - margin;
      const Eigen::Vector3d high = solid.box.max().array() + margin;
      solid.box = {low, high};
      for (auto& face : solid.faces) face.offset() -= margin;
    }
  }
  return solids;
}

template <typename Obstacles>
bool IntersectsAny(const SurfacePoints& surface, const Eigen::Isometry3d& pose,
                   const Obstacles& obstacles) {
  return std::any_of(obstacles.begin(), obstacles.end(), [&](const auto& obstacle) {
    return PenetrationIntoBody(surface, pose, *obstacle.solids, obstacle.poses) > kPenetration;
  });
}

}  // namespace

CollisionChecker::CollisionChecker(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, int held)
    : context_(context), world_from_robot_(interaction.subtask.start.world_from_robot) {
  for (const int object : interaction.placed) {
    if (object == held) continue;
    const auto t = static_cast<size_t>(object);
    obstacles_.push_back({&interaction.solids[t], WorldLinkPoses(interaction.model.objects[t],
                                                                 state.roots[t], state.joints[t])});
  }
  const std::vector<Eigen::Isometry3d> home =
      RobotPoses(*context.robot, world_from_robot_, context.robot->home());
  for (size_t l = 0; l < home.size(); ++l) {
    touches_floor_.push_back(IntersectsFloor(context.robot_surface[l], home[l]));
  }
}

void CollisionChecker::SetClearance(double margin, std::vector<robot::JointVector> ends) {
  ends_ = std::move(ends);
  inflated_solids_.clear();
  inflated_ = obstacles_;
  for (const Obstacle& obstacle : obstacles_) {
    inflated_solids_.push_back(Inflated(*obstacle.solids, margin));
  }
  for (size_t i = 0; i < inflated_.size(); ++i) inflated_[i].solids = &inflated_solids_[i];
}

bool CollisionChecker::IsCollisionFree(const robot::JointVector& arm, Fingers fingers) const {
  return IsClearOf(obstacles_, arm, fingers);
}

bool CollisionChecker::IsClearOf(const Obstacles& obstacles, const robot::JointVector& arm,
                                 Fingers fingers) const {
  const std::vector<int>& finger_links = context_.robot->gripper.links;
  const std::vector<Eigen::Isometry3d> robot = RobotPoses(*context_.robot, world_from_robot_, arm);
  for (size_t l = 0; l < robot.size(); ++l) {
    const SurfacePoints& surface = context_.robot_surface[l];
    if (fingers == Fingers::kIgnored && std::find(finger_links.begin(), finger_links.end(),
                                                  static_cast<int>(l)) != finger_links.end()) {
      continue;
    }
    if (!touches_floor_[l] && IntersectsFloor(surface, robot[l])) return false;
    if (IntersectsAny(surface, robot[l], obstacles)) return false;
  }
  return true;
}

bool CollisionChecker::IsLoadClearOf(const Obstacles& obstacles,
                                     const robot::JointVector& arm) const {
  if (carried_.points.empty()) return true;
  const Eigen::Isometry3d tool =
      world_from_robot_ * robot::ForwardKinematics(context_.robot->arm, arm);
  return !IntersectsFloor(carried_, tool) && !IntersectsAny(carried_, tool, obstacles);
}

bool CollisionChecker::IsPathCollisionFree(const robot::JointVector& from,
                                           const robot::JointVector& to) const {
  const double length = (to - from).lpNorm<Eigen::Infinity>();
  const int checks = 1 + static_cast<int>(length / kCheckStep);
  for (int i = checks; i > 0; --i) {  // obstacles are usually near the target end
    const double share = static_cast<double>(i) / checks;
    const robot::JointVector at = from + share * (to - from);
    const bool near_end = std::any_of(ends_.begin(), ends_.end(), [&](const auto& end) {
      return (end - at).template lpNorm<Eigen::Infinity>() < kNearEnd;
    });
    const Obstacles& obstacles = near_end || inflated_.empty() ? obstacles_ : inflated_;
    if (!IsClearOf(obstacles, at, Fingers::kCount) || !IsLoadClearOf(obstacles, at)) return false;
  }
  return true;
}

bool IsArmCollisionFree(const PlanningArm& context, const Interaction& interaction,
                        const tasks::WorldState& state, const robot::JointVector& arm, int held) {
  return CollisionChecker(context, interaction, state, held).IsCollisionFree(arm);
}

}  // namespace simwright::manipulation
