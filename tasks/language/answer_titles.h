#pragma once

#include <string>

namespace simwright::tasks {

// Returns true for a heading that names a section of an answer ("Reward function") instead of a
// task.
bool IsSectionTitle(const std::string& title);

// Returns the title that a function's name contains: "compute_reward_open_door" gives "open_door",
// "compute_reward_v5" gives an empty string.
std::string TitleOfFunction(std::string name);

// Returns the title without its explanation: "Open the door: pull its handle" gives "Open the
// door".
std::string TitlePart(const std::string& text);

}  // namespace simwright::tasks
