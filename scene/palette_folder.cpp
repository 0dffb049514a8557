#include "scene/palette_folder.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "assets/asset_folder.h"
#include "core/error.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

// "teapot" of "teapot_3", "apple_2" of "apple_2_3": the number at the end is the seed.
std::string SlotOf(const std::string& name) {
  size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
  const bool seeded = digits > 1 && digits < name.size() && name[digits - 1] == '_';
  return seeded ? name.substr(0, digits - 1) : name;
}

}  // namespace

Palette ReadPalette(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw core::Error("there is no folder of assets", folder.string(),
                      "make one with `simwright library`");
  }
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (assets::IsAssetFolder(entry.path())) entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  Palette palette;
  for (const fs::path& path : entries) {
    const std::string slot = SlotOf(path.filename().string());
    if (palette.Has(slot)) continue;
    const assets::Asset asset = assets::ReadAsset(path);
    palette.Add(slot, sim::BodyFromAsset(asset), asset.visual);
  }
  if (entries.empty()) throw core::Error("there is no rigid asset", folder.string());
  return palette;
}

}  // namespace simwright::scene
