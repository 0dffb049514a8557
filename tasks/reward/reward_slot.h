#pragma once

#include <string>

#include "tasks/reward/environment_api.h"

namespace simwright::tasks {

// One block of numbers that a program reads.
struct RewardSlot {
  RewardInput input = RewardInput::kParameter;
  std::string asset;     // empty where the input is not of an asset
  std::string part;      // link or joint; for a parameter its name
  int width = 1;         // numbers an environment
  std::string shape;     // as the program sees it, "[N, 3]", "[N] flags"
  bool flags = false;    // a parameter of flags, each 0 or 1
  bool uniform = false;  // one number for all environments (a joint's limit, a float parameter)
};

}  // namespace simwright::tasks
