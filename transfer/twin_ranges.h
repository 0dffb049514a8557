#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "skills/skill_options.h"

namespace simwright::transfer {

// Returns the ranges in which a training in the twin places its objects, to each side: `sigmas`
// times position_error in x and y, and `sigmas` times yaw_error, at most half a turn. Throws
// core::Error as workflows::ReadTwin does, and for a twin without objects.
std::map<std::string, skills::PlacementRange> PlacementRanges(const std::filesystem::path& twin,
                                                              double sigmas);

}  // namespace simwright::transfer
