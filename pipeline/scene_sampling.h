#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/scene_generation.h"
#include "scene/model/scene_model.h"

namespace simwright::pipeline {

struct SceneSamplingRequest {
  std::filesystem::path weights;
  std::string type;  // of scene: with the shipped weights, where `weights` is empty
  int count = 16;
  std::filesystem::path output;
  std::vector<std::filesystem::path> assets;  // folders, the first first; the library for the rest
  // Assets that the model has not seen, by the slot that is new with them.
  scene::SlotFolders added;
  scene::SampleOptions sampling;
  bool raw = false;    // as the model has them
  bool force = false;  // replace an output that exists
};

struct SceneSamplingReport {
  std::filesystem::path output;
  SceneStatistics statistics;  // "yield": the share that is sound once made feasible
  bool raw = false;
  double sampling_seconds = 0.0, physics_seconds = 0.0;
};

// Samples scenes of a trained model into output/part_00000.h5, a dataset as `scene generate` writes
// it, with its assets and a sheet of pictures. Unless `raw`, each is moved apart and settled; what
// is not sound then is left out, and counted. Throws core::Error for weights that are none, an
// output that exists, a type without weights, or assets for a model that does not know classes by
// their shape.
SceneSamplingReport SampleScenes(const SceneSamplingRequest& request, core::Progress* progress);

std::string SamplingTable(const SceneSamplingReport& report);
std::string SamplingJson(const SceneSamplingReport& report);

}  // namespace simwright::pipeline
