#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skills/episode_start.h"

namespace simwright::skills {

// Converts a start state to one line of JSON (docs/formats.md) and back, bit for bit. ParseStart
// throws core::Error, naming `where`, for a text of another form and for one that does not fit the
// skill: a variant, object, joint or configuration that the skill does not have, a non-finite
// number.
std::string StartText(const StartState& start);
StartState ParseStart(std::string_view text, const Skill& skill, const std::string& where);

// Reads and writes files of start states, one per line: end states of one skill, from which the
// next may begin. Throws core::Error as above, or if the file cannot be read or written; reads at
// most 100,000.
void WriteStarts(const std::vector<StartState>& starts, const std::filesystem::path& file);
std::vector<StartState> ReadStarts(const std::filesystem::path& file, const Skill& skill);

}  // namespace simwright::skills
