#pragma once

#include <string>
#include <vector>

#include "scene/asset_set/asset_set_folder.h"

namespace simwright::cli {

// Parses the values "SLOT=FOLDER" of `option`. Throws core::Error for a malformed value or a
// category that is named twice.
scene::CategoryFolders ParseCategoryFolders(const std::vector<std::string>& values,
                                            const std::string& option);

}  // namespace simwright::cli
