#pragma once

#include <filesystem>

#include "scene/dataset/scene_dataset.h"
#include "scene/palette.h"

namespace simwright::pipeline {

// The first twelve scenes of a dataset from the side, as one PNG; none for a dataset without any.
void WriteSceneSheet(const scene::SceneDataset& dataset, const scene::Palette& palette,
                     const std::filesystem::path& path);

}  // namespace simwright::pipeline
