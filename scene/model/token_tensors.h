#pragma once

#include <vector>

#include "scene/dataset/pose_range.h"
#include "scene/model/scene_diffusion.h"

namespace simwright::scene {

// Converts tokens (B x entries x TokenWidth) to the tensors of the model.
CleanScenes TensorsOf(const std::vector<float>& tokens, const Vocabulary& vocabulary,
                      const PoseRange& range);

// Converts tensors to tokens: one-hot classes, zero poses for empty ones.
std::vector<float> TokensOf(const CleanScenes& scenes, const Vocabulary& vocabulary,
                            const PoseRange& range);

}  // namespace simwright::scene
