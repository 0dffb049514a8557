#pragma once

#include <string>
#include <vector>

#include "scene/palette_folder.h"

namespace simwright::cli {

// Of values "SLOT=FOLDER" of `option`. Throws core::Error for one that is no
// such thing, or a slot that is named twice.
scene::SlotFolders SlotFoldersOf(const std::vector<std::string>& values, const std::string& option);

}  // namespace simwright::cli
