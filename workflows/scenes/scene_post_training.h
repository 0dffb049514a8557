#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "steering/post_training/post_training.h"

namespace simwright::workflows {

struct ScenePostTrainingRequest {
  std::filesystem::path weights;  // a model; empty: the shipped one of `type`
  std::string type;
  std::filesystem::path data;         // the dataset that the model was trained on, with its assets
  std::filesystem::path assets;       // a folder of asset folders; empty: the dataset's
  std::string objective = "objects";  // steering::RewardNamed
  // The wanted scene in words; the reward is the agreement with it instead of `objective`. A model
  // that reads prompts also samples with it.
  std::string prompt;
  steering::PostTrainingOptions options;
  // The chosen checkpoint's classifier accuracy is at most this, 0.5 to 1.
  double largest_accuracy = 0.95;
  int compared_scenes = 256;  // samples before and after
  int settled_scenes = 64;    // of them that go through physics
  std::filesystem::path output;
  bool force = false;  // replaces an existing output
};

// Samples of a model.
struct PostTrainingSamples {
  int scenes = 0;
  double reward = 0.0;        // mean
  double objects = 0.0;       // mean number, furniture included
  int most_objects = 0;       // of a scene
  double furnished = 0.0;     // share of scenes with the furniture of some scene of the data
  double accuracy = 0.0;      // of a classifier against data, 0.5 to 1
  int settled = 0;            // scenes that went through physics
  double valid = 0.0;         // share of them that are feasible and furnished
  double kept_objects = 0.0;  // mean number of objects after physics, furniture included
  int most_kept_objects = 0;  // of a scene
};

struct ScenePostTrainingReport {
  std::filesystem::path output;
  std::string objective;
  bool continuous = false;
  double data_objects = 0.0;  // mean number in the data's training scenes
  int data_most_objects = 0;
  PostTrainingSamples before, after;
  steering::PostTrainingReport training;
  double largest_accuracy = 1.0;
  double seconds = 0.0;
  core::Findings findings;
};

// Post-trains a model of scenes for a reward (steering::PostTrain), and compares samples before,
// with as many entries as the model had, and after. Rewards that need physics see each scene after
// scene::MakeFeasible, in which what it drops is not feasible; scenes without the furniture of
// their type have the reward 0. Writes model.pt, the checkpoints, rounds.csv, reward.svg,
// before_after.png and report.json. Resumes in an existing folder if the trainer's options ask for
// it. Throws core::Error for an objective, a model or data that do not fit, or an existing output.
ScenePostTrainingReport PostTrainScenes(const ScenePostTrainingRequest& request,
                                        core::Progress* progress);

// Format the report as text for people and as JSON, and its rewards as curves (SVG).
std::string PostTrainingTable(const ScenePostTrainingReport& report);
std::string PostTrainingJson(const ScenePostTrainingReport& report);
std::string PostTrainingCurves(const ScenePostTrainingReport& report);

}  // namespace simwright::workflows
