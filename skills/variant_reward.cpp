#include "skills/variant_reward.h"

#include <cstdint>

namespace simwright::skills {

VariantReward::VariantReward(const SkillVariant& variant)
    : program_(*variant.program),
      workspace_(program_, 1),
      reader_(variant.model, program_.slots()),
      bindings_(program_.slots().size()) {}

float VariantReward::Run(const tasks::WorldState& state, const tasks::WorldState& previous,
                         double time_step, bool* success) {
  reader_.Read(state, &previous, time_step, &values_);
  for (size_t i = 0; i < values_.size(); ++i) bindings_[i].data = values_[i].data();
  float reward = 0.0f;
  std::uint8_t done = 0;
  program_.Run(bindings_, 1, &workspace_, &reward, &done);
  *success = done != 0;
  return reward;
}

}  // namespace simwright::skills
