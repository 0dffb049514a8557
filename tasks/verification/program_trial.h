#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "tasks/reward/reward_program.h"
#include "tasks/scene_state.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// What a program says of some states.
struct TrialResult {
  std::vector<float> reward;
  std::vector<std::uint8_t> success;  // zeros where the program has none
};

// Runs `program` on `states`, each an environment. Velocities are those of a motion where
// `follows` is true: state i is then taken to come from state i - 1. Empty for no states.
TrialResult RunOnStates(const RewardProgram& program, const SceneModel& model,
                        const std::vector<SceneState>& states, bool follows);

// States far and wide: joints up to a fifth beyond their limits, the things that the program looks
// at within a metre of where they start, the gripper at a link or anywhere near, holding or not.
std::vector<SceneState> RandomStates(const SceneModel& model, const SceneState& start,
                                     const std::vector<RewardSlot>& slots, int count,
                                     core::Rng& rng);

}  // namespace simwright::tasks
