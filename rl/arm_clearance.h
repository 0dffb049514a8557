#pragma once

#include <utility>
#include <vector>

#include "rl/skill.h"

namespace simwright::rl {

// Of the robot: whether its fingers count. Those of a hand at work are about what it works on.
enum class Fingers { kCount, kIgnored };

// Where the robot's links, fingers open, are in none of the things that the variant places, nor in
// the floor, as far as its surface, looked at every few centimetres, can tell. For one state of the
// scene; constant but for what the hand carries.
class ArmClearance {
 public:
  // The thing `held` (-1: none) does not count. All must outlive this.
  ArmClearance(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
               int held = -1);

  ArmClearance(const ArmClearance&) = delete;  // KeepOff's obstacles are pointed to
  ArmClearance& operator=(const ArmClearance&) = delete;

  bool IsClear(const robot::Posture& arm, Fingers fingers = Fingers::kCount) const;  // (J)
  // The surface (m, the tool's frame) of what the hand carries: IsWayClear then asks that this is
  // in nothing either. Nothing carried at first.
  void Carry(SurfacePoints carried) { carried_ = std::move(carried); }
  // IsWayClear then asks that the arm keeps `margin` (m) off things, but within 0.3 rad (or m) of
  // `ends` (J each), which may be near things: what it goes by may give way, and the arm is never
  // quite where it is sent.
  void KeepOff(double margin, std::vector<robot::Posture> ends);
  // Whether the arm, and what it carries, is clear between the two postures (J), as it goes
  // straight from joint to joint, and at the second.
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
  Obstacles obstacles_, grown_;  // `grown_`: by KeepOff's margin
  std::vector<BodySolids> grown_solids_;
  std::vector<robot::Posture> ends_;  // of KeepOff
  SurfacePoints carried_;
  std::vector<bool> grounded_;  // by link: is in the floor at home, as the foot of an arm may be
};

// ArmClearance::IsClear, for one posture.
bool IsArmClear(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                const robot::Posture& arm, int held = -1);

}  // namespace simwright::rl
