#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "core/ranks.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_shard.h"
#include "scene/feasibility/feasible_scene.h"

namespace simwright::workflows {

struct SceneGenerationRequest {
  std::string type;  // from scene::SceneTypes()
  int count = 100;   // the dataset's number of scenes
  std::uint64_t seed = 1;
  std::filesystem::path output;
  std::vector<std::filesystem::path> assets;  // asset folders, searched in this order
  scene::CategoryFolders chosen;              // the asset folder of a category
  std::vector<std::string> hulls;             // categories whose assets collide as convex hulls
  int part = 64;                              // scenes per shard, the unit of work of one worker
  double time_step = 0.0;  // the physics', s; 0: the default of scene::FeasibilityOptions
  core::RankPlace place;   // among the processes that one command line started
  bool raw = false;        // keeps the grammar's scenes, without physics (scene::Generation::raw)
};

// The statistics of a dataset and its generation.
struct SceneStatistics {
  std::string type;
  bool physics = true;  // false: scenes as sampled, so that nothing was dropped or measured
  int scenes = 0, attempts = 0;
  // The rejected attempts that physics accepts but that have fewer free objects than a scene needs
  // (scene::FeasibilityOptions::fewest).
  int too_few = 0;
  double yield = 0.0;                           // accepted scenes over attempts
  double mean_objects = 0.0, mean_drawn = 0.0;  // including furniture; per scene, per sample
  int most_objects = 0;
  double dropped = 0.0;                   // mean objects per scene
  double moved = 0.0;                     // mean, m
  double penetration = 0.0, drift = 0.0;  // the worst of all scenes, m
  // Samples and accepted scenes by their number of objects: the effect of the physics filter.
  std::vector<int> drawn_counts, scene_counts;
  int elsewhere = 0;  // shards that other workers are making
  // False: another rank, or the last task of a Slurm array, reports the dataset. All other members
  // except `elsewhere` are then empty.
  bool reported = true;
  // The fraction of the sampled objects of scenes that was kept. Objects that interpenetrated, fell
  // or found no support are dropped.
  double kept = 1.0;
  core::Findings findings;
};

// Returns "objects-dropped", a warning with the fraction, if more than a tenth of the objects was
// dropped.
core::Findings DroppedFindings(const SceneStatistics& statistics);

SceneStatistics StatisticsOf(const std::vector<scene::SceneAttempt>& attempts);

// Samples scenes into output/part_NNNNN.h5. Any number of workers may do so concurrently; each
// takes the next unclaimed shard. Existing shards are kept, and an interrupted shard is resumed.
// The assets are kept in output/assets, a contact sheet of the first scenes in output/scenes.png,
// and the statistics in output/statistics.json. Of the ranks of one launcher the first waits for
// the others, makes what they leave behind, and alone writes pictures and statistics; of a Slurm
// array the task that finds all shards complete does. Throws core::Error for an unknown type or an
// output that contains other scenes.
SceneStatistics GenerateScenes(const SceneGenerationRequest& request, core::Progress* progress);

// Format the statistics as text for people and as JSON.
std::string StatisticsTable(const SceneStatistics& statistics);
std::string StatisticsJson(const SceneStatistics& statistics);

}  // namespace simwright::workflows
