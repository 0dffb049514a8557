#pragma once

#include "skills/episode.h"

namespace simwright::skills {

// Returns true if the skill has a scripted expert: its actions are relative to the interaction
// target (ActionSpace::kTargetFrame, kGuided).
bool HasScriptedExpert(const Skill& skill);

// Writes the scripted expert's action (7, in [-1, 1]) into `action`. It knows only the pose of the
// target (Episode::frame): it moves there, closes, pulls a part along its direction of motion or
// turns it about its axis, carries an object to its destination, releases objects that are to be
// put down, and pushes objects that are to be pushed. It depends on the episode's state alone and
// has no memory, so that a policy can imitate it from any state. It succeeds in some of the
// episodes of any skill, but not in all: a starting point for learning. The skill must have a
// scripted expert.
void ExpertAction(const Episode& episode, float* action);

}  // namespace simwright::skills
