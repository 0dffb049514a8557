#include "scene/metrics/asset_frequency.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::scene {

std::vector<std::int64_t> AssetCounts(const std::vector<std::vector<SceneObject>>& scenes,
                                      const Vocabulary& vocabulary) {
  std::vector<std::int64_t> counts(vocabulary.categories.size(), 0);
  for (const std::vector<SceneObject>& objects : scenes) {
    for (const SceneObject& object : objects) {
      const int index = vocabulary.ClassOf(object.category);
      if (index < 0) throw core::Error("the vocabulary has no such category", object.category);
      ++counts[static_cast<size_t>(index)];
    }
  }
  return counts;
}

double FrequencyDivergence(const std::vector<std::int64_t>& data,
                           const std::vector<std::int64_t>& generated) {
  if (data.empty() || data.size() != generated.size()) {
    throw core::Error("frequencies are compared over the same classes, at least one");
  }
  double all_data = 0.0, all_generated = 0.0;
  for (size_t i = 0; i < data.size(); ++i) {
    if (data[i] < 0 || generated[i] < 0) throw core::Error("a count is at least 0");
    all_data += static_cast<double>(data[i]) + kAddedObjects;
    all_generated += static_cast<double>(generated[i]) + kAddedObjects;
  }
  double divergence = 0.0;
  for (size_t i = 0; i < data.size(); ++i) {
    const double p = (static_cast<double>(data[i]) + kAddedObjects) / all_data;
    const double q = (static_cast<double>(generated[i]) + kAddedObjects) / all_generated;
    divergence += p * std::log(p / q);
  }
  return std::max(0.0, divergence);
}

}  // namespace simwright::scene
