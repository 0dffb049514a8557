#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/dataset/scene_part.h"
#include "scene/feasible_scene.h"
#include "scene/palette_folder.h"

namespace simwright::pipeline {

struct SceneGenerationRequest {
  std::string type;  // of scene::SceneTypes()
  int count = 100;   // scenes that the dataset is to have
  std::uint64_t seed = 1;
  std::filesystem::path output;
  std::vector<std::filesystem::path> assets;  // folders of assets, the first first
  scene::SlotFolders chosen;                  // an asset folder for a slot
  std::vector<std::string> hulls;             // slots whose assets collide as their hulls
  int part = 64;                              // scenes of a part: what one worker makes at a time
  double time_step = 0.0;  // s, of physics; 0: as measured to hold (scene::FeasibilityOptions)
};

// What a dataset holds and how it came about.
struct SceneStatistics {
  std::string type;
  int scenes = 0, attempts = 0;
  // Of the attempts that are no scenes, those that physics accepts, but with fewer free objects
  // than a scene needs (scene::FeasibilityOptions::fewest).
  int too_few = 0;
  double yield = 0.0;                           // share of the attempts that are scenes
  double mean_objects = 0.0, mean_drawn = 0.0;  // furniture included; of scenes, of all draws
  int most_objects = 0;
  double dropped = 0.0;                   // objects a scene, the mean
  double moved = 0.0;                     // m, the mean
  double penetration = 0.0, drift = 0.0;  // m, the worst of the scenes
  // Draws and scenes by their number of objects: what the filter does to it.
  std::vector<int> drawn_counts, scene_counts;
  int elsewhere = 0;  // parts that other workers are making
  // Of the objects of scenes as they were drawn, the share that was kept: what interpenetrated, fell
  // or found no support is dropped.
  double kept = 1.0;
  core::Findings findings;
};

// "objects-dropped", a warning where more than a tenth of the objects was, with how many.
core::Findings DroppedFindings(const SceneStatistics& statistics);

SceneStatistics StatisticsOf(const std::vector<scene::SceneAttempt>& attempts);

// Draws scenes into output/part_NNNNN.h5, which any number of workers may do at once: each takes
// the next part that nobody has. What is there already is kept, and a part that was stopped goes
// on. Its assets are kept in output/assets; a sheet of the first scenes goes to output/scenes.png
// and the statistics to output/statistics.json. Throws core::Error for an unknown type, or an
// output that holds other scenes.
SceneStatistics GenerateScenes(const SceneGenerationRequest& request, core::Progress* progress);

// As text for people, and as JSON.
std::string StatisticsTable(const SceneStatistics& statistics);
std::string StatisticsJson(const SceneStatistics& statistics);

}  // namespace simwright::pipeline
