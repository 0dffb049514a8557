#pragma once

#include <vector>

#include "core/random.h"
#include "rl/skill.h"

namespace simwright::rl {

struct ReachingPosture {
  robot::Posture posture;  // (J)
  double seconds = 0.0;    // to get there, every joint at its highest speed
};

// Some postures with the tool at `world_from_tool`, sought from `from` (J) and from random ones
// farther and farther about it. None where it is out of reach.
std::vector<ReachingPosture> PosturesAt(const Skill& skill, const SkillVariant& variant,
                                        const Eigen::Isometry3d& world_from_tool,
                                        const robot::Posture& from, core::Rng& rng);

}  // namespace simwright::rl
