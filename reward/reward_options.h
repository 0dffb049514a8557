#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace simwright::reward {

// The bounds of a reward program and the caller's knowledge of it. A program that exceeds a bound
// is rejected with a finding.
struct RewardOptions {
  std::size_t max_source_bytes = 64 * 1024;
  int max_tokens = 20'000;
  int max_depth = 100;      // nesting of expressions and blocks
  int max_call_depth = 16;  // nesting of function calls
  int max_steps = 100'000;  // statements and operations, with loops unrolled
  int max_lanes = 4096;     // numbers per environment in one tensor
  int max_nodes = 200'000;  // scalar operations per environment, before sharing
  std::size_t max_workspace_bytes = std::size_t{64} << 20;
  int max_findings = 20;

  // The name of the reward function; empty: the function named compute_reward..., or ..reward.. .
  std::string entry;
  // Trailing shapes of tensor parameters, e.g. {"object_pos", {3}} for [N, 3], {} for [N]. Shapes
  // that are not given are inferred from the uses of the parameters.
  std::map<std::string, std::vector<int>> parameter_shapes;
  // Tensor parameters that hold flags, 0 or 1. Other flag parameters are inferred.
  std::set<std::string> flag_parameters;

  // Returns false if a bound is out of its own range, and describes it in `error` unless null.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::reward
