#pragma once

#include "scene/model/model_options.h"

namespace simwright::scene {

// A model that learns datasets of a few classes within a minute.
inline SceneModelOptions SmallSceneModel() {
  SceneModelOptions options;
  options.width = 64;
  options.double_blocks = 1;
  options.single_blocks = 2;
  options.diffusion_steps = 100;
  options.class_weight = 30.0;
  return options;
}

}  // namespace simwright::scene
