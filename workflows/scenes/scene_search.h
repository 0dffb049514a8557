#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/model/scene_model.h"
#include "steering/search/scene_search.h"
#include "workflows/scenes/scene_stability.h"
#include "workflows/scenes/search_objective.h"

namespace simwright::workflows {

struct SceneSearchRequest {
  std::filesystem::path weights;  // a model; empty: the shipped one of `type`
  std::string type;
  std::filesystem::path text_encoder;  // of a model that was trained with an external one
  SearchObjective objective;
  // A scene to start from, in any form that ReadSceneSource takes; empty: an unconditional sample.
  std::filesystem::path start;
  std::string start_scene;  // of a dataset; empty: the first
  steering::SearchOptions search;
  steering::RepairOptions repair;
  bool random = false;                                // also draws as many unconditional samples
  scene::SampleOptions sampling = DefaultSampling();  // steps, eta, clamping
  std::filesystem::path assets;  // a folder of asset folders, preferred to the library
  std::filesystem::path output;
  int save_every = 10;  // iterations between two states on disk
  bool resume = false;  // continues the search in `output`
  bool force = false;   // replaces an existing output

  static scene::SampleOptions DefaultSampling();  // 50 steps
};

struct SceneSearchReport {
  std::filesystem::path output;
  std::string objective;  // in words
  double goal = 0.0;
  std::vector<steering::SearchRecord> records, random_records;  // by iteration
  double start_reward = 0.0, best_reward = 0.0;
  int best_iteration = 0;  // that found the best scene; 0: the start
  int depth = 0;           // of the best scene in the tree
  bool reached_goal = false, interrupted = false;
  int feasible_in_search = 0;  // feasible objects of the best scene, furniture included
  // The best scene after full physics: its objects, furniture included, and its reward.
  int objects = 0;
  double final_reward = 0.0;
  SceneStability stability;  // not of an interrupted search
  core::Findings findings;
  // s, of this run: the model and physics in the iterations, and in total.
  double model_seconds = 0.0, physics_seconds = 0.0, seconds = 0.0;
  int iterations_run = 0;  // in these seconds

  // Returns true if the search was not interrupted and the finished scene is still in both engines.
  bool Succeeded() const { return !interrupted && stability.Still(); }
};

// Searches for the scene with the largest reward (steering::SceneSearch), checks the best one in
// Bullet and MuJoCo, and drops what moves. Writes it as a dataset with its assets, search.json,
// search.svg, best_path.png and scenes.png. The state is saved on the way; after Ctrl-C the best
// scene so far is written, too, and `resume` continues. Throws core::Error for invalid options, an
// unknown objective or mask, a start scene that the model cannot have, or an existing output.
SceneSearchReport SearchScenes(const SceneSearchRequest& request, core::Progress* progress);

// Returns the curve of the best reward by samples as an SVG page.
std::string SearchCurves(const SceneSearchReport& report);

// Format the report as text for people and as JSON.
std::string SearchTable(const SceneSearchReport& report);
std::string SearchJson(const SceneSearchReport& report);

}  // namespace simwright::workflows
