#pragma once

#include <string>
#include <vector>

#include "scene/dataset/tokens.h"
#include "scene/grammar/scene_sample.h"
#include "scene/scene_types/scene_types.h"

namespace simwright::scene {

// Returns a free object of the category at this position, without rotation.
inline SceneObject PromptObject(const std::string& category, double x, double y, double z) {
  SceneObject object;
  object.category = category;
  object.world_from_object.translation() = Eigen::Vector3d(x, y, z);
  return object;
}

// Returns samples of a scene type's grammar, before physics.
inline std::vector<std::vector<SceneObject>> PromptScenes(const std::string& type, int count) {
  const Grammar grammar = SceneTypeNamed(type).make(DefaultCategorySizes());
  std::vector<std::vector<SceneObject>> scenes;
  for (int i = 0; i < count; ++i) {
    core::Rng rng = core::StreamRng(11, static_cast<std::uint64_t>(i));
    scenes.push_back(SampleGrammar(grammar, rng).objects);
  }
  return scenes;
}

}  // namespace simwright::scene
