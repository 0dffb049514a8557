#pragma once

#include <vector>

#include "skills/skill.h"
#include "tasks/world_signals.h"

namespace simwright::skills {

// The reward program of one variant, with its workspace. One thread at a time.
class VariantReward {
 public:
  // `variant` must outlive it.
  explicit VariantReward(const SkillVariant& variant);

  // Returns the program's reward for `state`, with `previous` being `time_step` (s) earlier, and
  // writes to `success` whether the subtask is done. Allocates nothing after the first call.
  float Run(const tasks::WorldState& state, const tasks::WorldState& previous, double time_step,
            bool* success);

 private:
  reward::RewardProgram program_;
  reward::RewardWorkspace workspace_;
  tasks::SignalReader reader_;
  std::vector<std::vector<float>> values_;
  std::vector<reward::RewardBinding> bindings_;
};

}  // namespace simwright::skills
