#pragma once

#include <filesystem>

#include "scene/model/denoiser.h"
#include "scene/model/scene_model.h"

namespace simwright::scene {

// A model's weights with what it says of itself, in half precision. Written beside and renamed in.
void WriteWeights(const Denoiser& denoiser, const SceneModelFacts& facts,
                  const std::filesystem::path& path);

struct ReadModel {
  SceneModelFacts facts;
  std::shared_ptr<Denoiser> denoiser;  // in evaluation mode
};
// Throws core::Error where the file is missing, damaged, or of another kind.
ReadModel ReadWeights(const std::filesystem::path& path);

}  // namespace simwright::scene
