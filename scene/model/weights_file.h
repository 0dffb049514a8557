#pragma once

#include <filesystem>

#include "scene/model/denoiser.h"
#include "scene/model/scene_model.h"

namespace simwright::scene {

// Writes a model's weights with its metadata, in half precision. Atomic: writes a temporary file
// and renames it.
void WriteWeights(const Denoiser& denoiser, const SceneModelMetadata& metadata,
                  const std::filesystem::path& path);

struct ReadModel {
  SceneModelMetadata metadata;
  std::shared_ptr<Denoiser> denoiser;  // in evaluation mode
};
// Reads a model. Throws core::Error if the file is missing, damaged, or of another kind.
ReadModel ReadWeights(const std::filesystem::path& path);

}  // namespace simwright::scene
