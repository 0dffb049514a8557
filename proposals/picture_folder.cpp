#include "proposals/picture_folder.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "proposals/category_proposals.h"

namespace simwright::proposals {
namespace {
namespace fs = std::filesystem;

constexpr int kMostPictures = 100'000;

bool IsPicture(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr const char* kExtensions[] = {".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tif", ".tiff"};
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
         std::end(kExtensions);
}

// Returns the category that a file's name states: "coffee_mug_02.jpg" is a coffee mug.
std::string CategoryOfFile(const fs::path& file) {
  std::string stem = file.stem().string();
  while (!stem.empty() && (std::isdigit(static_cast<unsigned char>(stem.back())) ||
                           stem.back() == '_' || stem.back() == '-' || stem.back() == ' ')) {
    stem.pop_back();
  }
  return SafeCategory(stem);
}

}  // namespace

PictureFolder ReadPictureFolder(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw core::Error("is not a folder of pictures", folder.string(),
                      "name pictures by category: DIR/mug/*.jpg or DIR/mug_1.jpg");
  }
  PictureFolder pictures;
  int entries = 0;
  const auto visit = [&](const fs::path& place, const std::string& category) {
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(place, code)) {
      if (++entries > kMostPictures) {
        throw core::Error("has more than 100,000 entries", folder.string(), "split the folder");
      }
      if (entry.is_symlink(code) || !entry.is_regular_file(code) || !IsPicture(entry.path())) {
        continue;
      }
      if (entry.path().filename().string().front() == '.') continue;
      const std::string name = category.empty() ? CategoryOfFile(entry.path()) : category;
      if (name.empty()) {
        ++pictures.unnamed;
      } else {
        pictures.by_category[name].push_back(entry.path());
      }
    }
  };
  visit(folder, "");
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    if (entry.is_symlink(code) || !entry.is_directory(code)) continue;
    const std::string name = entry.path().filename().string();
    const std::string category = SafeCategory(name);
    if (!category.empty()) {
      visit(entry.path(), category);
    } else if (name.front() != '.') {
      ++pictures.unnamed_folders;
    }
  }
  for (auto& [category, files] : pictures.by_category) std::sort(files.begin(), files.end());
  return pictures;
}

}  // namespace simwright::proposals
