#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rl/episode_start.h"

namespace simwright::rl {

// A start as one line of JSON (docs/formats.md), and back, bit for bit. ParseStart throws
// core::Error, naming `where`, for a text of another form, or one that does not fit the skill: a
// variant, thing, joint or posture that it does not have, a number that is not finite.
std::string StartText(const EpisodeStart& start);
EpisodeStart ParseStart(std::string_view text, const Skill& skill, const std::string& where);

// A file of starts, one a line: where one skill ended well and the next may begin. Throws
// core::Error as above, or where the file cannot be read or written; at most 100,000 are read.
void WriteStarts(const std::vector<EpisodeStart>& starts, const std::filesystem::path& file);
std::vector<EpisodeStart> ReadStarts(const std::filesystem::path& file, const Skill& skill);

}  // namespace simwright::rl
