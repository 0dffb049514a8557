#include "cli/slot_folders.h"

#include "core/error.h"

namespace simwright::cli {

scene::SlotFolders SlotFoldersOf(const std::vector<std::string>& values,
                                 const std::string& option) {
  scene::SlotFolders folders;
  for (const std::string& value : values) {
    const size_t equals = value.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == value.size()) {
      throw core::Error("this is no SLOT=FOLDER", option + " " + value);
    }
    folders[value.substr(0, equals)] = value.substr(equals + 1);
  }
  return folders;
}

}  // namespace simwright::cli
