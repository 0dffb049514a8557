#pragma once

#include <cstdint>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_draw.h"

namespace simwright::scene {

// How often each class stands in scenes, furniture included, what pads them left out (classes
// without the empty one). Throws core::Error for a slot that the vocabulary does not know.
std::vector<std::int64_t> AssetCounts(const std::vector<std::vector<DrawnObject>>& scenes,
                                      const Vocabulary& vocabulary);

// Half an object that FrequencyDivergence adds to each class of both sides.
inline constexpr double kAddedObjects = 0.5;

// Kullback-Leibler divergence KL(data || generated), nats, of the classes' shares of all objects.
// Half an object is added to each class on both sides (Krichevsky and Trofimov 1981), so that a
// class that one of them never has costs much, not infinitely much. Throws core::Error where the
// sizes differ or are 0, or a count is negative.
double FrequencyDivergence(const std::vector<std::int64_t>& data,
                           const std::vector<std::int64_t>& generated);

}  // namespace simwright::scene
