#include "rl/training_options.h"

namespace simwright::rl {

bool TrainingOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (max_samples < 1) return fail("a training needs at least one sample");
  if (!(max_seconds >= 0.0)) return fail("the time limit must not be negative");
  if (!(success_target >= 0.0 && success_target < 1.0)) {
    return fail("the success target must be in [0, 1): an interval's lower end never reaches 1");
  }
  if (success_window < 1 || checkpoint_every < 1 || examine_every < 1) {
    return fail("success_window, checkpoint_every and examine_every must be at least 1");
  }
  return ppo.IsValid(error);
}

}  // namespace simwright::rl
