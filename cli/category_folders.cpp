#include "cli/category_folders.h"

#include "core/error.h"

namespace simwright::cli {

scene::CategoryFolders ParseCategoryFolders(const std::vector<std::string>& values,
                                            const std::string& option) {
  scene::CategoryFolders folders;
  for (const std::string& value : values) {
    const size_t equals = value.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == value.size()) {
      throw core::Error("this is not of the form SLOT=FOLDER", option + " " + value);
    }
    if (!folders.emplace(value.substr(0, equals), value.substr(equals + 1)).second) {
      throw core::Error("a category has two folders", option + " " + value);
    }
  }
  return folders;
}

}  // namespace simwright::cli
