#pragma once

#include <vector>

#include "core/random.h"
#include "rl/skill.h"

namespace simwright::rl {

// A solution of the inverse kinematics.
struct ReachingPosture {
  robot::Posture posture;  // (J)
  double seconds = 0.0;    // to reach it, every joint at its highest speed
};

// Solves the inverse kinematics for several configurations with the tool at `world_from_tool`,
// starting from `from` (J) and from random configurations increasingly far from it. Empty if the
// pose is out of reach.
std::vector<ReachingPosture> PosturesAt(const Skill& skill, const SkillVariant& variant,
                                        const Eigen::Isometry3d& world_from_tool,
                                        const robot::Posture& from, core::Rng& rng);

}  // namespace simwright::rl
