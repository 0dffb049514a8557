#pragma once

#include <filesystem>
#include <string>

#include "steering/search/scene_search.h"

namespace simwright::steering {

// Writes the state of a search atomically into a sealed HDF5 file (docs/formats.md). `settings`:
// text that says what the search was asked for. Throws core::Error if it cannot be written.
void WriteSearchState(const SearchState& state, const scene::Vocabulary& vocabulary,
                      const std::string& settings, const std::filesystem::path& path);

// Reads a state. Throws core::Error, naming the file, if it is missing, damaged, of another
// vocabulary, or if its settings are not these.
SearchState ReadSearchState(const std::filesystem::path& path, const scene::Vocabulary& vocabulary,
                            const std::string& settings);

}  // namespace simwright::steering
