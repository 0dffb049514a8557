#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/palette.h"

namespace simwright::scene {

// A palette of the asset folders in `folder` (docs/formats.md), rigid ones: "teapot_3" stands for
// the slot "teapot", and of several for one slot the first by name does. Whatever else lies there
// is passed over. Throws core::Error where the folder cannot be read, an asset is damaged, or none
// is there.
Palette ReadPalette(const std::filesystem::path& folder);

// Asset folders by the slot that they stand for.
using SlotFolders = std::map<std::string, std::filesystem::path>;

// Which of the rigid asset folders in `folder` stands for which of `slots`: the one of its name
// ("apple"), else the first that is it with a seed ("apple_7", unless that is a slot itself), else
// the first whose category it is. Slots that nothing stands for are left out. Throws core::Error
// where the folder or an asset's description cannot be read.
SlotFolders FoldersForSlots(const std::filesystem::path& folder,
                            const std::vector<std::string>& slots);

// A palette of these. Throws core::Error where an asset is damaged or has no collision parts.
Palette ReadPalette(const SlotFolders& folders);

}  // namespace simwright::scene
