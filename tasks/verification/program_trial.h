#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "reward/reward_program.h"
#include "tasks/verification/motion.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

// The outputs of a program for a sequence of states.
struct TrialResult {
  std::vector<float> reward;
  std::vector<std::uint8_t> success;  // zeros if the program has no success
};

// Runs `program` on `states`, each as one environment. If `follows` is true, velocities are
// computed along the sequence: state i follows state i - 1. Returns empty results for no states.
TrialResult RunOnStates(const reward::RewardProgram& program, const WorldModel& model,
                        const std::vector<WorldState>& states, bool follows);

// Returns random states: joints up to a fifth of their range beyond their limits, the objects that
// the program reads within a metre of their start, the gripper at a link or anywhere near, holding
// an object or not.
std::vector<WorldState> RandomStates(const WorldModel& model, const WorldState& start,
                                     const std::vector<reward::RewardSlot>& slots, int count,
                                     core::Rng& rng);

}  // namespace simwright::tasks
