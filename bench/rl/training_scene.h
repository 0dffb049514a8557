#pragma once

#include <memory>

#include "rl/skill.h"

namespace simwright {

// A Panda before a microwave of the library with a cup beside it, and the subtask of opening the
// microwave's door: what bench_environment_speed measures. Makes both assets, a few seconds.
rl::SkillSubtask MicrowaveAndCup();

}  // namespace simwright
