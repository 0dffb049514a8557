#pragma once

#include <utility>
#include <vector>

#include "rl/skill.h"

namespace simwright::rl {

// The treatment of the fingers in a collision check. Fingers at a grasp are in contact with the
// target.
enum class Fingers { kCount, kIgnored };

// A collision checker for the robot, fingers open, against the placed objects and the floor, for
// one scene state. It samples the surface of each link every few centimetres. Constant except for
// the payload.
class ArmClearance {
 public:
  // Ignores the object `held` (-1: none). All arguments must outlive this.
  ArmClearance(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
               int held = -1);

  ArmClearance(const ArmClearance&) = delete;  // the obstacles of KeepOff hold pointers
  ArmClearance& operator=(const ArmClearance&) = delete;

  bool IsClear(const robot::Posture& arm, Fingers fingers = Fingers::kCount) const;  // (J)
  // Sets the surface points (m, tool frame) of the payload, which IsWayClear also checks from then
  // on. Initially there is no payload.
  void Carry(SurfacePoints carried) { carried_ = std::move(carried); }
  // Makes IsWayClear require a clearance of `margin` (m) to objects, except within 0.3 rad (or m)
  // of the configurations `ends` (J each), which may be near objects: objects beside the path may
  // move when touched, and the arm lags behind its command.
  void KeepOff(double margin, std::vector<robot::Posture> ends);
  // Returns true if the arm and its payload are collision-free along the straight joint-space
  // segment between two configurations (J), and at the second one.
  bool IsWayClear(const robot::Posture& from, const robot::Posture& to) const;

 private:
  struct Obstacle {
    const BodySolids* solids;
    std::vector<Eigen::Isometry3d> poses;  // world_from_link (links)
  };
  using Obstacles = std::vector<Obstacle>;

  bool IsClearOf(const Obstacles& obstacles, const robot::Posture& arm, Fingers fingers) const;
  bool IsLoadClear(const robot::Posture& arm) const;

  const Skill& skill_;
  const Eigen::Isometry3d& world_from_robot_;
  Obstacles obstacles_, inflated_;  // `inflated_`: inflated by the margin of KeepOff
  std::vector<BodySolids> inflated_solids_;
  std::vector<robot::Posture> ends_;  // exempt from the margin of KeepOff
  SurfacePoints carried_;
  std::vector<bool> touches_floor_;  // by link: touches the floor at home, as an arm's base may
};

// Returns ArmClearance::IsClear for one configuration.
bool IsArmClear(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                const robot::Posture& arm, int held = -1);

}  // namespace simwright::rl
