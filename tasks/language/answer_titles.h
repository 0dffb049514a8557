#pragma once

#include <string>

namespace simwright::tasks {

// True for a heading that names a section of an answer ("Reward function"), not a task.
bool IsSectionTitle(const std::string& title);

// What a function's name says that it is for: "compute_reward_open_door" -> "open_door"; empty for
// "compute_reward_v5".
std::string TitleOfFunction(std::string name);

// "Open the door: pull its handle" -> "Open the door".
std::string TitlePart(const std::string& text);

}  // namespace simwright::tasks
