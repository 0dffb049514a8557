#pragma once

#include <memory>

#include "skills/skill.h"

namespace simwright {

// Returns the scene of bench_environment_speed: a Panda in front of a microwave of the library with
// a cup beside it, and the subtask of opening the microwave's door. Makes both assets, which takes
// a few seconds.
skills::SkillSubtask MicrowaveAndCup();

}  // namespace simwright
