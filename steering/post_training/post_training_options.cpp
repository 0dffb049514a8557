#include "steering/post_training/post_training_options.h"

namespace simwright::steering {

PostTrainingOptions::PostTrainingOptions() {
  trainer.learning_rate = 3e-4;
  trainer.warm_share = 0.02;
  trainer.weight_decay = 0.0;
  trainer.ema_decay = 0.9;
}

bool PostTrainingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!trainer.IsValid(error)) return false;
  if (rounds < 1 || rounds > 1'000'000) return fails("rounds must be 1 to 1000000");
  if (scenes < 2) return fails("scenes must be at least 2: rewards are compared");
  if (steps < 2) return fails("steps must be at least 2");
  if (gradient_steps < 1 || gradient_steps > steps - 1) {
    return fails("gradient_steps must be 1 to steps - 1");
  }
  if (updates < 1 || updates > 1000) return fails("updates must be 1 to 1000");
  if (!(clip > 0.0)) return fails("clip must be above 0");
  if (data_batch < 1) return fails("data_batch must be at least 1");
  if (!(data_weight >= 0.0)) return fails("data_weight must be at least 0");
  if (more_entries < 0 || more_entries > 1000) return fails("more_entries must be 0 to 1000");
  if (score_every < 1) return fails("score_every must be at least 1");
  if (scored_scenes < 8) return fails("scored_scenes must be at least 8");
  return true;
}

}  // namespace simwright::steering
