#pragma once

#include <vector>

#include "scene/dataset/pose_range.h"
#include "scene/model/scene_diffusion.h"

namespace simwright::scene {

// Tokens (B x entries x TokenWidth) as the model takes them.
CleanScenes TensorsOf(const std::vector<float>& tokens, const Vocabulary& vocabulary,
                      const PoseRange& range);

// And back: classes one-hot, empty ones' poses zero.
std::vector<float> TokensOf(const CleanScenes& scenes, const Vocabulary& vocabulary,
                            const PoseRange& range);

}  // namespace simwright::scene
