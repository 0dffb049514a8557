#include "reward/reward_options.h"

namespace simwright::reward {
namespace {

struct Bound {
  const char* name;
  long long value, least, most;
};

}  // namespace

bool RewardOptions::IsValid(std::string* error) const {
  const Bound bounds[] = {
      {"max_source_bytes", static_cast<long long>(max_source_bytes), 1, 16 << 20},
      {"max_tokens", max_tokens, 1, 4'000'000},
      // Each level costs the compiler some stack.
      {"max_depth", max_depth, 4, 400},
      {"max_call_depth", max_call_depth, 1, 64},
      {"max_steps", max_steps, 1, 100'000'000},
      {"max_lanes", max_lanes, 1, 1 << 20},
      {"max_nodes", max_nodes, 1, 50'000'000},
      {"max_workspace_bytes", static_cast<long long>(max_workspace_bytes), 4096, 1LL << 40},
      {"max_findings", max_findings, 1, 10'000},
  };
  for (const Bound& bound : bounds) {
    if (bound.value >= bound.least && bound.value <= bound.most) continue;
    if (error != nullptr) {
      *error = std::string(bound.name) + " is " + std::to_string(bound.value) +
               ", it must be between " + std::to_string(bound.least) + " and " +
               std::to_string(bound.most);
    }
    return false;
  }
  for (const auto& [name, shape] : parameter_shapes) {
    long long lanes = 1;
    for (const int size : shape) {
      if (size >= 1 && lanes <= max_lanes) lanes *= size;
      if (size >= 1 && lanes <= max_lanes) continue;
      if (error != nullptr) *error = "the shape of parameter " + name + " is out of range";
      return false;
    }
  }
  return true;
}

}  // namespace simwright::reward
