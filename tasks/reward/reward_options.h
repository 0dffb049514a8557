#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace simwright::tasks {

// Bounds of a reward program, and what its caller knows of it. A program that passes a bound is
// refused with a finding.
struct RewardOptions {
  std::size_t max_source_bytes = 64 * 1024;
  int max_tokens = 20'000;
  int max_depth = 100;      // of nested expressions and blocks
  int max_call_depth = 16;  // of functions calling each other
  int max_steps = 100'000;  // statements and operations, loops unrolled
  int max_lanes = 4096;     // numbers an environment in one tensor
  int max_nodes = 200'000;  // scalar operations an environment, before sharing
  std::size_t max_workspace_bytes = std::size_t{64} << 20;
  int max_findings = 20;

  // The function that gives the reward; empty: the one named compute_reward..., or ..reward.. .
  std::string entry;
  // Trailing shapes of tensor parameters, e.g. {"object_pos", {3}} for [N, 3], {} for [N]. Those
  // not named are inferred from how they are used.
  std::map<std::string, std::vector<int>> parameter_shapes;
  // Tensor parameters that hold flags, 0 or 1. Those not named are inferred as well.
  std::set<std::string> flag_parameters;

  // False where a bound is out of its own range; says which in `error` unless null.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::tasks
