#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/steered_scene.h"

namespace simwright::workflows {

struct SceneSteeringRequest {
  std::filesystem::path scene;    // any form that ReadSceneSource takes
  std::string scenes;             // of a dataset: "0,3-5"; empty: the first
  std::filesystem::path weights;  // a model; empty: the shipped one of `type`
  std::string type;               // empty: the type that the source records
  SteeringGoal goal;
  std::string prompt;  // of a completion: what to add, instead of goal.count and goal.names
  std::filesystem::path text_encoder;  // of a model that was trained with an external one
  // Rounds of proposals, and proposals per round and scene, of which the best is taken. Objects
  // that find no place in one round are proposed again in the next.
  int attempts = 6, candidates = 2;
  scene::SampleOptions sampling = DefaultSampling();
  std::filesystem::path assets;  // a folder of asset folders; empty: the source's, then the library
  std::filesystem::path output;
  bool force = false;  // replaces an existing output

  static scene::SampleOptions DefaultSampling();  // 50 steps
};

// The result for one scene.
struct SteeredSceneReport {
  std::string name;                   // of the source's scene
  int kept = 0, asked = 0, done = 0;  // objects kept, to be added or moved, and added or moved
  int attempts = 0;
  double kept_displacement = 0.0;  // m, of a kept object once everything is free; in the file: 0
  double penetration = 0.0;        // m, the deepest of a pair with a new or moved object
  double drift = 0.0;              // m, the largest of a new or moved object in the check
  // True if nothing moves by more than 1 mm once everything is free; false if kept objects are
  // `unstable`, whatever the others do.
  bool stable = false;
  std::vector<std::string> unstable;  // kept objects that move by themselves, and are held
  int statements = 0;                 // relations and tiers that the prompt asks for
  std::vector<std::string> broken;    // those that do not hold
  std::vector<std::string> missing;   // names of objects to add without a place; any name: empty
  std::vector<std::string> returned;  // objects without a new pose, back at their old one
  std::vector<std::string> lost;      // objects of a rearrangement without any place
};

struct SceneSteeringReport {
  std::filesystem::path output;
  bool rearrange = false;
  std::vector<SteeredSceneReport> scenes;
  core::Findings findings;
  // s, of the steps and in total. `asset_seconds` is the time for reading and copying assets.
  double model_seconds = 0.0, sampling_seconds = 0.0, physics_seconds = 0.0, asset_seconds = 0.0,
         picture_seconds = 0.0, seconds = 0.0;

  // Returns true if all scenes are stable and no object is lost.
  bool Succeeded() const;
};

// Completes or rearranges scenes with a model: samples proposals with the kept objects given,
// finds each new or moved object a place among the kept ones, which stand exactly where they stood,
// and checks for two seconds that with everything free no kept object moves by more than 1 mm.
// Writes a dataset as `scene sample` does, with its assets, scenes.png, before_after.png and
// report.json. Throws core::Error for a source, a goal or a model that does not fit, or an existing
// output.
SceneSteeringReport SteerScenes(const SceneSteeringRequest& request, core::Progress* progress);

// Returns warnings for objects that found no place, kept objects that move by themselves, relations
// that do not hold, and scenes that are not stable.
core::Findings SteeringFindings(const std::vector<SteeredSceneReport>& scenes, bool rearrange);

// Format the report as text for people and as JSON.
std::string SteeringTable(const SceneSteeringReport& report);
std::string SteeringJson(const SceneSteeringReport& report);

}  // namespace simwright::workflows
