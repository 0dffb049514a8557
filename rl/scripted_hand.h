#pragma once

#include "rl/episode.h"

namespace simwright::rl {

// Whether there is a script for the skill: its actions are seen from what the hand works on
// (ActionSpace::kFocus, kGuided).
bool HasScript(const Skill& skill);

// What a hand does that knows only where its work is (Episode::frame), into `action` (7, in
// [-1, 1]): it gets there, closes, pulls a part along the part's own way or turns it about its
// axis, brings a thing to its destination, lets go there of what is to be put down, pushes what is
// to be pushed. It depends on the episode's state alone and remembers nothing, so that a policy can
// learn it from any state. It succeeds in some of the episodes of any skill and in all of none: a
// place to begin learning from. The skill must have a script.
void ScriptedAction(const Episode& episode, float* action);

}  // namespace simwright::rl
