#pragma once

#include <cstdint>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// Returns the number of objects of each class in the scenes (all classes but the empty one),
// furniture included, padding excluded. Throws core::Error for a category that the vocabulary
// lacks.
std::vector<std::int64_t> AssetCounts(const std::vector<std::vector<SceneObject>>& scenes,
                                      const Vocabulary& vocabulary);

// The pseudo-count that FrequencyDivergence adds to each class of both sides.
inline constexpr double kAddedObjects = 0.5;

// Returns the Kullback-Leibler divergence KL(data || generated), nats, of the class frequencies.
// Half an object is added to each class on both sides (Krichevsky and Trofimov 1981), so that a
// class that is missing on one side has a large but finite cost. Throws core::Error if the sizes
// differ or are 0, or a count is negative.
double FrequencyDivergence(const std::vector<std::int64_t>& data,
                           const std::vector<std::int64_t>& generated);

}  // namespace simwright::scene
