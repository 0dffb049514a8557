#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace simwright::proposals {

// The pictures of a folder by category (normalised name), each list in order of its paths:
// DIR/mug/*.jpg, DIR/mug.png, DIR/mug_1.jpg. PNG, JPEG, WebP, BMP and TIFF; links and hidden files
// are left out.
struct PictureFolder {
  std::map<std::string, std::vector<std::filesystem::path>> by_category;
  int unnamed = 0;          // pictures whose name is no category
  int unnamed_folders = 0;  // folders whose name is no category; hidden ones do not count
};

// Throws core::Error unless `folder` is a folder with at most 100,000 entries.
PictureFolder ReadPictureFolder(const std::filesystem::path& folder);

}  // namespace simwright::proposals
