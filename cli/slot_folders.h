#pragma once

#include <string>
#include <vector>

#include "scene/palette_folder.h"

namespace simwright::cli {

// Parses the values "SLOT=FOLDER" of `option`. Throws core::Error for a malformed value or a
// category that is named twice.
scene::SlotFolders SlotFoldersOf(const std::vector<std::string>& values, const std::string& option);

}  // namespace simwright::cli
