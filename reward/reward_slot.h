#pragma once

#include <string>

#include "reward/environment_api.h"

namespace simwright::reward {

// One input of a program: a block of numbers per environment.
struct RewardSlot {
  RewardInput input = RewardInput::kParameter;
  std::string asset;     // empty if the input belongs to no asset
  std::string part;      // link or joint; name of a parameter
  int width = 1;         // numbers per environment
  std::string shape;     // shape in the program, "[N, 3]", "[N] flags"
  bool flags = false;    // true for a parameter of flags, each 0 or 1
  bool uniform = false;  // one number for all environments (a joint's limit, a float parameter)
};

}  // namespace simwright::reward
