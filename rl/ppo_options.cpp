#include "rl/ppo_options.h"

#include <algorithm>

namespace simwright::rl {
namespace {

// What is wrong, or nothing. Comparisons are written so that NaN fails them.
std::string FaultOfNetwork(const PpoOptions& options) {
  if (options.hidden.empty() || options.hidden.size() > 16) {
    return "a network has 1 to 16 hidden layers";
  }
  if (!std::all_of(options.hidden.begin(), options.hidden.end(),
                   [](int size) { return size >= 1 && size <= 1 << 14; })) {
    return "a hidden layer has 1 to 16384 units";
  }
  if (!(options.smallest_std > 0.0 && options.smallest_std <= options.initial_std &&
        options.initial_std <= options.largest_std && options.largest_std <= 100.0)) {
    return "standard deviations are positive: the smallest, the initial, the largest, in order";
  }
  return "";
}

std::string FaultOfSamples(const PpoOptions& options) {
  if (!(options.discount >= 0.0 && options.discount < 1.0)) return "the discount lies in [0, 1)";
  if (!(options.lambda >= 0.0 && options.lambda <= 1.0)) return "lambda lies in [0, 1]";
  if (options.horizon < 1 || options.epochs < 1 || options.minibatch < 2) {
    return "an update takes a step, an epoch and a minibatch of 2 at least";
  }
  if (options.critic_samples < 0) return "the number of the critic's samples is not negative";
  if (options.imitated_samples < 0 || options.imitation_steps < 1) {
    return "the number of imitated samples is not negative, imitation takes a step";
  }
  if (!(options.largest_dropped_share >= 0.0 && options.largest_dropped_share <= 1.0)) {
    return "the share of dropped samples lies in [0, 1]";
  }
  return "";
}

std::string FaultOfDescent(const PpoOptions& options) {
  if (!(options.clip > 0.0 && options.clip < 1.0)) return "the ratio's clip lies in (0, 1)";
  if (!(options.value_clip >= 0.0)) return "the value's clip is not negative";
  if (!(options.value_weight > 0.0) || !(options.entropy_weight >= 0.0)) {
    return "the value's weight is positive, the entropy's not negative";
  }
  if (!(options.gradient_norm > 0.0)) return "the gradient's largest norm is positive";
  if (!(options.smallest_rate > 0.0 && options.smallest_rate <= options.learning_rate &&
        options.learning_rate <= options.largest_rate && options.largest_rate <= 1.0)) {
    return "learning rates are positive: the smallest, the first, the largest, in order";
  }
  if (!(options.target_kl >= 0.0)) return "the target KL divergence is not negative";
  if (!(options.adam_epsilon > 0.0)) return "Adam's epsilon is positive";
  return "";
}

}  // namespace

bool PpoOptions::IsValid(std::string* error) const {
  std::string fault = FaultOfNetwork(*this);
  if (fault.empty()) fault = FaultOfSamples(*this);
  if (fault.empty()) fault = FaultOfDescent(*this);
  if (error != nullptr) *error = fault;
  return fault.empty();
}

}  // namespace simwright::rl
