// A small dataset and small models for tests of post-training.
#pragma once

#include <filesystem>
#include <vector>

#include "core/random.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/model/model_options.h"
#include "tests/steering/steering_scenes.h"

namespace simwright::steering {

// Writes `count` scenes of a table with one to three cups or plates, of at most 8 entries.
inline void WriteTableScenes(const std::filesystem::path& folder, int count) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  scene::SceneShard part{vocabulary, {5, 0, "{}", "{}", "1"}, {}, {}};
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  core::Rng rng = core::StreamRng(4, 0);
  for (int i = 0; i < count; ++i) {
    std::vector<scene::SceneObject> objects = {ObjectAt("table", 0, 0, 0)};
    for (int k = 0; k <= i % 3; ++k) {
      objects.push_back(ObjectAt(core::Uniform(rng) < 0.5 ? "cup" : "plate",
                                 core::Uniform(rng) - 0.5, core::Uniform(rng) - 0.5, kTableTop));
    }
    part.tokens.resize(part.tokens.size() + size);
    scene::EncodeScene(objects, vocabulary, &part.tokens[part.tokens.size() - size]);
    part.attempts.push_back({4, 4, 0, true, true, 0, 0, 0});
  }
  scene::WriteShard(part, folder / scene::ShardName(0));
}

inline scene::SceneModelOptions SmallModel(bool continuous) {
  scene::SceneModelOptions options;
  options.continuous = continuous;
  options.width = 32;
  options.double_blocks = options.single_blocks = 1;
  options.diffusion_steps = 100;
  return options;
}

}  // namespace simwright::steering
