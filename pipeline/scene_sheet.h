#pragma once

#include <filesystem>

#include "scene/dataset/scene_dataset.h"
#include "scene/palette.h"

namespace simwright::pipeline {

// Renders the first twelve scenes of a dataset from the side into one PNG; writes nothing for an
// empty dataset.
void WriteSceneSheet(const scene::SceneDataset& dataset, const scene::Palette& palette,
                     const std::filesystem::path& path);

}  // namespace simwright::pipeline
