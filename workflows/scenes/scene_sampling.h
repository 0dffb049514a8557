#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/scene_generation.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {

// The distance by which sampled objects are lowered, m: about one shelf spacing, so that an object
// between two boards comes down on the lower one; less than a table's height, so that an object
// beside it falls.
inline constexpr double kSampleLowering = 0.25;

struct SceneSamplingRequest {
  std::filesystem::path weights;
  // The scene type of the shipped weights, if `weights` is empty; else one of the model's.
  std::string type;
  int count = 16;
  std::filesystem::path output;
  std::vector<std::filesystem::path> assets;  // searched in this order, then the library
  // Assets that the model has not seen, by their new category.
  scene::CategoryFolders added;
  scene::SampleOptions sampling;
  // Free text (scene::ReadPrompt): scene i has prompt i % n of `prompts` and then the lines of
  // `prompt_file`; none: unprompted. sampling.prompts is set from these, and sampling.limits unless
  // `free_counts`.
  std::vector<std::string> prompts;
  std::filesystem::path prompt_file;
  // True: the network alone decides how many objects there are of each name; it is close on
  // average. Always so for continuous classes.
  bool free_counts = false;
  std::filesystem::path text_encoder;  // of a model that was trained with an external one
  bool raw = false;                    // keeps the model's samples unchanged
  bool force = false;                  // replaces an existing output
};

struct SceneSamplingReport {
  std::filesystem::path output;
  SceneStatistics statistics;  // "yield": the fraction that is valid after projection
  bool raw = false;
  double sampling_seconds = 0.0, physics_seconds = 0.0;
  std::vector<PromptReport> prompts;  // one per prompt
};

// Samples scenes from a trained model into output/part_00000.h5, a dataset in the format of `scene
// generate`, with its assets and a contact sheet. Unless `raw`, interpenetrations of each scene are
// resolved and it is settled; scenes that are then not valid are omitted and counted. Throws
// core::Error for a file without weights, an existing output, a type without weights, assets for a
// model that does not embed shapes, prompts for one that reads none, or as scene::ReadPrompt does.
SceneSamplingReport SampleScenes(const SceneSamplingRequest& request, core::Progress* progress);

std::string SamplingTable(const SceneSamplingReport& report);
std::string SamplingJson(const SceneSamplingReport& report);

}  // namespace simwright::workflows
