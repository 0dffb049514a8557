#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "asset_lift/lift.h"
#include "core/progress.h"
#include "rl/wilson_interval.h"
#include "workflows/skills/skill_training.h"

namespace simwright::workflows {

struct PhotoRunRequest {
  std::filesystem::path photo;
  std::string category;
  std::optional<std::filesystem::path> mask;
  double height = 0.0;  // m; 0: sampled from the category's range
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFast;
  std::string furniture = "any";  // drawer_unit, microwave, or "any": the first that fits
  std::string task;               // the name or pattern of one task; empty: pick up the asset
  int environments = 64;
  std::int64_t samples = 2'000'000;  // per subtask, at most
  double minutes = 20.0;             // per subtask, at most; 0: unlimited
  double target = 0.92;              // the success rate above which a subtask is learnt
  int episodes = 200;                // per evaluation
  std::int64_t imitated_samples = TrainRequest().imitated_samples;
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool resume = false, force = false;
};

struct PhotoRunOutcome {
  std::string task;
  int episodes = 0, successes = 0;
  rl::Interval interval;  // 95 %, of the success rate
  bool replayed = false;  // the trajectory file alone reproduces the task in simulation
  double seconds = 0.0;   // total of all stages
  std::filesystem::path folder, page, picture, trajectory;
  core::Findings findings;  // the asset's
  std::string json;         // report.json
};

// Turns a photo into a trained skill and its trajectory in request.output, in the stages of
// docs/run.md: the asset is reconstructed, checked and placed beside a piece of furniture that fits
// it; tasks are generated for both; one of them is trained, evaluated and exported; and a page
// shows all results. The results of a stage are kept if a later one fails or is stopped; `resume`
// continues from there. Throws core::Error wherever LiftToFolder, ChooseTasks, TrainTask and Export
// throw, for an asset that fails its check or that no gripper can grasp although the task requires
// it, and for an output that already exists or was started with other inputs. The error of a
// refused trajectory is thrown after the page is written. Throws core::Cancelled after Ctrl-C.
PhotoRunOutcome RunPhoto(const PhotoRunRequest& request, core::Progress* progress);

// Formats the outcome for a terminal.
std::string PhotoRunTable(const PhotoRunOutcome& outcome);

}  // namespace simwright::workflows
