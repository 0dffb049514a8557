#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "steering/post_training/post_training_options.h"

namespace simwright::steering {

// Scenes as a model samples them, before physics.
using SampledScenes = std::vector<std::vector<scene::SceneObject>>;

// The score of a checkpoint.
struct CheckpointScore {
  double reward = 0.0;    // mean of its scenes
  double accuracy = 0.5;  // of a classifier that separates its scenes from data; 0.5: it cannot
};

// The reward that post-training raises, and the measure of how far scenes have left the data.
struct PostTrainingGoal {
  // Returns the reward of each scene. Scene i has prompt i % prompts.size().
  std::function<std::vector<double>(const SampledScenes&)> rewards;
  // Returns the accuracy of the classifier for sampled scenes.
  std::function<double(const SampledScenes&)> accuracy;
  // A checkpoint may be chosen if its accuracy is at most this.
  double largest_accuracy = 1.0;
  std::vector<std::string> prompts;  // of a model that reads them; none: it samples without
  // Sizes of the categories, by which the prompts of the data are drawn.
  scene::CategorySizes sizes = scene::DefaultCategorySizes();
};

struct RoundRecord {
  int round = 0;                                    // from 1
  double reward = 0.0, least = 0.0, largest = 0.0;  // of the sampled scenes: mean, extremes
  double objects = 0.0;    // mean number of a scene's objects, furniture included
  int most_objects = 0;    // of a scene
  double ratio = 0.0;      // mean |importance ratio - 1| in the round's last update
  double data_loss = 0.0;  // mean of the round's updates
};

struct Checkpoint {
  int round = 0;  // 0: the model before post-training, with the additional entries
  CheckpointScore score;
  std::filesystem::path weights;
};

struct PostTrainingReport {
  std::vector<RoundRecord> rounds;
  std::vector<Checkpoint> checkpoints;
  int chosen = 0;  // an index into `checkpoints`
  double sampling_seconds = 0.0, reward_seconds = 0.0, update_seconds = 0.0,
         scoring_seconds = 0.0;  // of this run
};

// Files of a post-training folder beside those of a training (scene/model/training.h).
inline constexpr char kRoundsFile[] = "rounds.csv", kCheckpointsFile[] = "checkpoints.csv";

// Returns the index of the checkpoint to use: the one with the largest reward among those whose
// accuracy is at most `largest_accuracy`; without any, the one with the least accuracy.
int ChosenCheckpoint(const std::vector<Checkpoint>& checkpoints, double largest_accuracy);

// Post-trains the model in `weights`, continuous or mixed, for a reward. In each round it samples
// scenes, and takes updates along
//   mean over scenes and steps of  -min(A r, A clip(r, 1 - c, 1 + c))  +  w (loss on data),
// where A is the scene's advantage, and r = exp((log p - log p_old) / N) the importance ratio of
// the step for the N entries of a scene: of Gaussian poses and classes, or of Gaussian poses and
// categorical classes together. `data`: the scenes that the model was trained on. Writes the
// checkpoints, the chosen one as kWeightsFile, and the records into `output`; resumes there if the
// trainer's options ask for it. Throws core::Error for invalid options, a model or data that do not
// fit, a reward that is not finite, and if the loss is not finite several times in a row; the
// checkpoints so far stay.
PostTrainingReport PostTrain(const std::filesystem::path& weights, const scene::SceneDataset& data,
                             const PostTrainingGoal& goal, const PostTrainingOptions& options,
                             const std::filesystem::path& output, core::Progress* progress);

}  // namespace simwright::steering
