#pragma once

#include <utility>
#include <vector>

#include "manipulation/interaction.h"
#include "manipulation/path_checker.h"

namespace simwright::manipulation {

// The treatment of the fingers in a collision check. Fingers at a grasp are in contact with the
// target.
enum class Fingers { kCount, kIgnored };

// A collision checker for the robot, fingers open, against the placed objects and the floor, for
// one scene state. It samples the surface of each link every few centimetres. Constant except for
// the payload.
class CollisionChecker : public PathChecker {
 public:
  // Ignores the object `held` (-1: none). All arguments must outlive this.
  CollisionChecker(const PlanningArm& context, const Interaction& interaction,
                   const tasks::WorldState& state, int held = -1);

  CollisionChecker(const CollisionChecker&) =
      delete;  // the obstacles of SetClearance hold pointers
  CollisionChecker& operator=(const CollisionChecker&) = delete;

  bool IsCollisionFree(const robot::JointVector& arm,
                       Fingers fingers = Fingers::kCount) const;  // (J)
  bool IsConfigurationFree(const robot::JointVector& arm) const override {
    return IsCollisionFree(arm);
  }
  // Sets the surface points (m, tool frame) of the payload, which IsPathCollisionFree also checks
  // from then on. Initially there is no payload.
  void SetPayload(SurfacePoints carried) { carried_ = std::move(carried); }
  // Makes IsPathCollisionFree require a clearance of `margin` (m) of arm and payload to objects,
  // except within 0.3 rad (or m) of the configurations `ends` (J each), which may be near objects:
  // objects beside the path may move when touched, and the arm lags behind its command.
  void SetClearance(double margin, std::vector<robot::JointVector> ends);
  // Returns true if the arm and its payload are collision-free along the straight joint-space
  // segment between two configurations (J), and at the second one.
  bool IsPathCollisionFree(const robot::JointVector& from,
                           const robot::JointVector& to) const override;

 private:
  struct Obstacle {
    const BodyParts* solids;
    std::vector<Eigen::Isometry3d> poses;  // world_from_link (links)
  };
  using Obstacles = std::vector<Obstacle>;

  bool IsClearOf(const Obstacles& obstacles, const robot::JointVector& arm, Fingers fingers) const;
  bool IsLoadClearOf(const Obstacles& obstacles, const robot::JointVector& arm) const;

  const PlanningArm& context_;
  const Eigen::Isometry3d& world_from_robot_;
  Obstacles obstacles_, inflated_;  // `inflated_`: inflated by the margin of SetClearance
  std::vector<BodyParts> inflated_solids_;
  std::vector<robot::JointVector> ends_;  // exempt from the margin of SetClearance
  SurfacePoints carried_;
  std::vector<bool> touches_floor_;  // by link: touches the floor at home, as an arm's base may
};

// Returns CollisionChecker::IsCollisionFree for one configuration.
bool IsArmCollisionFree(const PlanningArm& context, const Interaction& interaction,
                        const tasks::WorldState& state, const robot::JointVector& arm,
                        int held = -1);

}  // namespace simwright::manipulation
