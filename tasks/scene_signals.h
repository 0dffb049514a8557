#pragma once

#include <vector>

#include "tasks/reward/reward_slot.h"
#include "tasks/scene_state.h"

namespace simwright::tasks {

// What the slots of a reward program hold in `state`: for each slot its numbers, as RewardInput
// says. Velocities are differences to `previous`, `time_step` (s) earlier; zero where it is null.
// `values` is resized to the slots, and each to its width. Parameters hold zeros. Throws
// core::Error for a slot of an asset, link or joint that the model does not have.
void SlotValues(const SceneModel& model, const SceneState& state, const SceneState* previous,
                double time_step, const std::vector<RewardSlot>& slots,
                std::vector<std::vector<float>>* values);

}  // namespace simwright::tasks
