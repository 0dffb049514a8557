#include "rl/ppo_options.h"

#include <algorithm>

namespace simwright::rl {
namespace {

// Returns the error message, or an empty string. Comparisons are written so that NaN fails them.
std::string NetworkError(const PpoOptions& options) {
  if (options.hidden.empty() || options.hidden.size() > 16) {
    return "a network must have 1 to 16 hidden layers";
  }
  if (!std::all_of(options.hidden.begin(), options.hidden.end(),
                   [](int size) { return size >= 1 && size <= 1 << 14; })) {
    return "a hidden layer must have 1 to 16384 units";
  }
  if (!(options.smallest_std > 0.0 && options.smallest_std <= options.initial_std &&
        options.initial_std <= options.largest_std && options.largest_std <= 100.0)) {
    return "the smallest, initial and largest std must be positive and ascending";
  }
  return "";
}

std::string SamplesError(const PpoOptions& options) {
  if (!(options.discount >= 0.0 && options.discount < 1.0)) return "the discount must be in [0, 1)";
  if (!(options.lambda >= 0.0 && options.lambda <= 1.0)) return "lambda must be in [0, 1]";
  if (options.horizon < 1 || options.epochs < 1 || options.minibatch < 2) {
    return "horizon and epochs must be at least 1, the minibatch at least 2";
  }
  if (options.critic_samples < 0) return "critic_samples must not be negative";
  if (options.imitated_samples < 0 || options.imitation_steps < 1) {
    return "imitated_samples must not be negative, imitation_steps at least 1";
  }
  if (!(options.largest_dropped_share >= 0.0 && options.largest_dropped_share <= 1.0)) {
    return "the share of dropped samples must be in [0, 1]";
  }
  return "";
}

std::string OptimizerError(const PpoOptions& options) {
  if (!(options.clip > 0.0 && options.clip < 1.0)) return "the ratio's clip must be in (0, 1)";
  if (!(options.value_clip >= 0.0)) return "the value's clip must not be negative";
  if (!(options.value_weight > 0.0) || !(options.entropy_weight >= 0.0)) {
    return "the value's weight must be positive, the entropy's not negative";
  }
  if (!(options.gradient_norm > 0.0)) return "the gradient's largest norm must be positive";
  if (!(options.smallest_rate > 0.0 && options.smallest_rate <= options.learning_rate &&
        options.learning_rate <= options.largest_rate && options.largest_rate <= 1.0)) {
    return "the smallest, initial and largest learning rate must be positive and ascending";
  }
  if (!(options.target_kl >= 0.0)) return "the target KL divergence must not be negative";
  if (!(options.adam_epsilon > 0.0)) return "Adam's epsilon must be positive";
  return "";
}

}  // namespace

bool PpoOptions::IsValid(std::string* error) const {
  std::string message = NetworkError(*this);
  if (message.empty()) message = SamplesError(*this);
  if (message.empty()) message = OptimizerError(*this);
  if (error != nullptr) *error = message;
  return message.empty();
}

}  // namespace simwright::rl
