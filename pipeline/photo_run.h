#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "asset_lift/lift.h"
#include "core/progress.h"
#include "pipeline/skill_training.h"
#include "rl/wilson_interval.h"

namespace simwright::pipeline {

struct PhotoRunRequest {
  std::filesystem::path photo;
  std::string category;
  std::optional<std::filesystem::path> mask;
  double height = 0.0;  // m; 0: drawn from the category's range
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFast;
  std::string furniture = "any";  // drawer_unit, microwave, or the first of them that fits
  std::string task;               // name or pattern of one task; empty: pick the asset up
  int environments = 64;
  std::int64_t samples = 2'000'000;  // of one subtask, at most
  double minutes = 20.0;             // of one subtask, at most; 0: no end
  double target = 0.92;              // a subtask is learnt above this (TrainRequest)
  int episodes = 200;                // of each evaluation
  std::int64_t imitated_samples = TrainRequest().imitated_samples;
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool resume = false, force = false;
};

struct PhotoRunOutcome {
  std::string task;
  int episodes = 0, successes = 0;
  rl::Interval interval;  // 95 %, of the success rate
  bool replayed = false;  // the trajectory repeats the task in simulation, from its file alone
  double seconds = 0.0;   // of all stages
  std::filesystem::path folder, page, picture, trajectory;
  core::Findings findings;  // of the asset
  std::string json;         // report.json
};

// A photo to a trained skill and its trajectory, in the stages of docs/run.md, into request.output:
// the asset is lifted, checked and put beside a piece of furniture that it fits, tasks are made of
// both, one of them is trained, evaluated and exported, and a page shows it all. What a stage has
// made stays when a later one fails or is stopped; `resume` goes on from there.
// Throws core::Error: what LiftToFolder, ChooseTasks, TrainTask and Export throw; an asset that
// fails its check, or that no hand can take where a hand has to; an output that is there already,
// or was begun with other inputs. A trajectory that is refused is thrown after the page is written.
// core::Cancelled after Ctrl-C.
PhotoRunOutcome RunPhoto(const PhotoRunRequest& request, core::Progress* progress);

// For a terminal.
std::string PhotoRunTable(const PhotoRunOutcome& outcome);

}  // namespace simwright::pipeline
