#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "scene/dataset/scene_dataset.h"
#include "scene/grammar/scene_draw.h"
#include "scene/palette_folder.h"

namespace simwright::pipeline {

// The scenes that `text` names, "0,3-5", in its order, each once. Throws core::Error where it is no
// such list, or names one that a dataset of `count` scenes has not.
std::vector<int> ScenesNamed(const std::string& text, int count);

// Scene `index` of the dataset. Throws core::Error where there is none, or it is damaged.
std::vector<scene::DrawnObject> SceneAt(const scene::SceneDataset& dataset, int index);

// Where the asset of each of `slots` lies: `assets`/SLOT, or where `assets` is empty in the folder
// "assets" beside the parts of the dataset at `path`. Throws core::Error where there is no such
// folder, one of the slots has no asset there (it says which), or a slot is no name for a folder.
scene::SlotFolders FoldersOfSlots(const std::filesystem::path& path,
                                  const std::filesystem::path& assets,
                                  const std::set<std::string>& slots);

// Throws core::Error, naming the slot, where what stands for one is not what the dataset's scenes
// were made with; a dataset that does not say passes.
void RequireSameAssets(const scene::SceneDataset& dataset, const scene::Palette& palette,
                       const std::set<std::string>& slots);

}  // namespace simwright::pipeline
