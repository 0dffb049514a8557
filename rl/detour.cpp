#include "rl/detour.h"

namespace simwright::rl {
namespace {

// Returns home with the base's joints and the first rotary joint as in `posture`.
robot::Posture Folded(const Skill& skill, const robot::Posture& posture) {
  robot::Posture folded = skill.robot->home();
  for (Eigen::Index j = 0; j < folded.size(); ++j) {
    folded[j] = posture[j];
    if (!skill.robot->arm.joints[static_cast<size_t>(j)].prismatic) break;
  }
  return folded;
}

}  // namespace

std::optional<Detour> PlanDetour(const Skill& skill, const ArmClearance& clearance,
                                 const robot::Posture& from, const robot::Posture& to) {
  const robot::Posture here = Folded(skill, from), there = Folded(skill, to);
  const robot::Posture& home = skill.robot->home();
  for (const Detour& detour :
       {Detour{}, Detour{here}, Detour{there}, Detour{here, there}, Detour{home},
        Detour{here, home}, Detour{home, there}, Detour{here, home, there}}) {
    robot::Posture at = from;
    bool clear = true;
    for (const robot::Posture& next : detour) {
      clear = clear && clearance.IsWayClear(at, next);
      at = next;
    }
    if (clear && clearance.IsWayClear(at, to)) return detour;
  }
  return std::nullopt;
}

}  // namespace simwright::rl
