#include "workflows/scenes/scene_post_training.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/folder_lock.h"
#include "core/parallel.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/metrics/classifier_accuracy.h"
#include "scene/model/scene_model.h"
#include "scene/model/training.h"
#include "steering/rewards/scene_rewards.h"
#include "workflows/scenes/before_after.h"
#include "workflows/scenes/dataset_scenes.h"
#include "workflows/scenes/post_training_settings.h"
#include "workflows/scenes/scene_prompts.h"
#include "workflows/scenes/scene_sampling.h"
#include "workflows/scenes/scene_set_features.h"
#include "workflows/scenes/scene_weights.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using steering::SampledScenes;

constexpr int kReferenceScenes = 512;  // of the data that samples are compared with
constexpr int kQuickRuns = 3;          // of the classifier for a checkpoint; 10 for the report

// Returns true if a folder has the files of a post-training, finished or stopped.
bool HasPostTraining(const fs::path& folder) {
  return fs::exists(folder / kPostTrainingSettingsFile) ||
         fs::exists(folder / scene::kWeightsFile) || fs::exists(folder / steering::kRoundsFile) ||
         fs::exists(folder / scene::kStateFile);
}

// Removes the files of an earlier post-training, so that none is taken for one of the new one.
void RemovePostTraining(const fs::path& folder) {
  for (const char* const file : {scene::kWeightsFile, scene::kStateFile, steering::kRoundsFile,
                                 steering::kCheckpointsFile, kPostTrainingSettingsFile}) {
    fs::remove(folder / file);
  }
  std::vector<fs::path> checkpoints;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("checkpoint_") && name.ends_with(".pt")) checkpoints.push_back(entry);
  }
  for (const fs::path& one : checkpoints) fs::remove(one);
}

void ValidatePostTraining(const ScenePostTrainingRequest& request) {
  std::string error;
  if (!request.options.IsValid(&error)) throw core::Error("post-training: " + error);
  if (!(request.largest_accuracy >= 0.5 && request.largest_accuracy <= 1.0)) {
    throw core::Error("the largest accuracy must be 0.5 to 1", "--largest-accuracy");
  }
  if (request.compared_scenes < 8) throw core::Error("at least 8 scenes are compared", "--count");
  if (request.settled_scenes < 0) throw core::Error("must be at least 0", "--settled");
  if (request.weights.empty() == request.type.empty()) {
    throw core::Error("give either weights or a scene type to post-train", "",
                      "name a weights file, or a --type with shipped weights");
  }
  if (request.options.trainer.resume && !fs::exists(request.output / kPostTrainingSettingsFile)) {
    throw core::Error("there is no post-training to resume", request.output.string(),
                      "leave --resume out to start one");
  }
  if (HasPostTraining(request.output) && !request.options.trainer.resume && !request.force) {
    throw core::Error("a post-training already exists", request.output.string(),
                      "continue with --resume, choose another folder, or replace it with --force");
  }
}

// The pieces of furniture that a scene has by category.
using FurnitureCounts = std::map<std::string, int>;

FurnitureCounts FurnitureOf(const std::vector<scene::SceneObject>& objects) {
  FurnitureCounts counts;
  for (const scene::SceneObject& object : objects) {
    if (object.welded) ++counts[object.category];
  }
  return counts;
}

// The numbers of pieces of furniture that scenes of the data have.
class FurnitureRule {
 public:
  explicit FurnitureRule(const SampledScenes& data) {
    for (const auto& one : data) seen_.insert(FurnitureOf(one));
  }
  // Returns true if some scene of the data has the same pieces.
  bool Holds(const std::vector<scene::SceneObject>& objects) const {
    return seen_.count(FurnitureOf(objects)) > 0;
  }

 private:
  std::set<FurnitureCounts> seen_;
};

// The scenes of the data that samples are compared with, and what they are compared by.
class DataComparison {
 public:
  DataComparison(const scene::SceneDataset& data, const scene::SceneModelMetadata& model,
                 const scene::AssetSet& asset_set, core::Findings* findings,
                 core::Progress* progress)
      : vocabulary_(data.vocabulary()),
        asset_set_(asset_set),
        features_(ShippedSceneFeatures(findings)) {
    if (!features_)
      throw core::Error("post-training needs the features of scenes", "",
                        "simwright scene features train makes them");
    // Held-out scenes, if there are some.
    const int held_out = data.SceneCount() - model.training_scenes;
    const bool use_held_out = model.training_scenes > 0 && held_out >= kReferenceScenes / 4;
    const int first = use_held_out ? model.training_scenes : 0;
    const int count = std::min(kReferenceScenes, use_held_out ? held_out : data.SceneCount());
    const SampledScenes scenes = DecodeScenes(data.Read(first, count), vocabulary_);
    progress->Stage("images of the data", count);
    reference_ = Features(scenes, progress);
    furniture_.emplace(scenes);
  }

  const FurnitureRule& furniture() const { return *furniture_; }

  // Returns the accuracy of the classifier, 0.5 to 1.
  double Accuracy(const SampledScenes& scenes, int runs, std::uint64_t seed) const {
    core::Progress silent;
    scene::AccuracyOptions options;
    options.runs = runs;
    options.scored_epochs = {50};
    options.learning_rate = kOwnFeaturesRate;
    options.seed = seed;
    const scene::FeatureMatrix features = Features(scenes, &silent);
    return ClassifierAccuracy(reference_, features, options).front().percent / 100.0;
  }

 private:
  scene::FeatureMatrix Features(const SampledScenes& scenes, core::Progress* progress) const {
    return FeaturesOfScenes(scenes, vocabulary_, asset_set_, *features_, progress);
  }

  const scene::Vocabulary& vocabulary_;
  const scene::AssetSet& asset_set_;
  std::optional<scene::SceneFeatures> features_;
  std::optional<FurnitureRule> furniture_;
  scene::FeatureMatrix reference_;
};

// The scene after physics, in which each dropped object is unstable.
steering::JudgedScene AfterPhysics(const std::vector<scene::SceneObject>& objects,
                                   const scene::AssetSet& asset_set) {
  scene::FeasibilityOptions options;
  options.lowering = kSampleLowering;
  const scene::FeasibleScene feasible = scene::MakeFeasible(objects, asset_set, options);
  steering::JudgedScene judged{objects, std::vector<char>(objects.size(), 0),
                               std::vector<char>(objects.size(), 0)};
  for (size_t i = 0; i < objects.size(); ++i) judged.unstable[i] = !objects[i].welded;
  for (size_t i = 0; i < feasible.indices.size(); ++i) {
    const auto from = static_cast<size_t>(feasible.indices[i]);
    judged.unstable[from] = 0;
    judged.objects[from].world_from_object = feasible.objects[i].world_from_object;
  }
  return judged;
}

// Returns the rewards of scenes; 0 for those without the furniture of their type, such as a shelf's
// objects without the shelf, which would count as much.
std::vector<double> RewardsOf(const SampledScenes& scenes, const steering::SceneReward& reward,
                              const FurnitureRule& furniture, const scene::AssetSet& asset_set) {
  std::vector<double> rewards(scenes.size());
  core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
    core::CheckCancelled();
    const auto at = static_cast<size_t>(i);
    if (!furniture.Holds(scenes[at])) return;
    rewards[at] = reward.NeedsPhysics() ? reward.Evaluate(AfterPhysics(scenes[at], asset_set))
                                        : reward.Evaluate({scenes[at], {}, {}});
  });
  return rewards;
}

struct Objective {
  std::unique_ptr<steering::SceneReward> reward;
  std::vector<std::string> prompts;  // as the model reads them
};

Objective ObjectiveOf(const ScenePostTrainingRequest& request,
                      const scene::SceneModelMetadata& model, const scene::AssetSet& asset_set,
                      core::Findings* findings) {
  // A scene may have more objects after post-training than the model's entries.
  scene::Vocabulary vocabulary = model.vocabulary;
  vocabulary.entries += request.options.more_entries;
  if (request.prompt.empty()) return {steering::RewardNamed(request.objective, vocabulary), {}};
  const std::vector<scene::Prompt> prompts =
      ReadPrompts({request.prompt}, {}, vocabulary, findings);
  return {steering::PromptReward(prompts.front(), asset_set.Sizes()),
          model.options.text ? TextsOf(prompts) : std::vector<std::string>()};
}

class Comparison {
 public:
  Comparison(const ScenePostTrainingRequest& request, const DataComparison& data,
             const Objective& objective, const scene::AssetSet& asset_set)
      : request_(request), data_(data), objective_(objective), asset_set_(asset_set) {}

  // Samples from the weights. `finished` receives the scenes after physics.
  PostTrainingSamples Of(const fs::path& weights, const std::string& name, SampledScenes* finished,
                         core::Progress* progress) const {
    const scene::SceneModel model = scene::SceneModel::Load(weights);
    scene::SampleOptions sampling;
    sampling.steps = request_.options.steps;
    sampling.seed = request_.options.seed;
    sampling.prompts = objective_.prompts;
    progress->Stage("samples " + name, request_.compared_scenes);
    const SampledScenes scenes = scene::DecodeScenes(
        model.Sample(request_.compared_scenes, sampling, progress), model.metadata().vocabulary);
    PostTrainingSamples samples;
    samples.scenes = static_cast<int>(scenes.size());
    const std::vector<double> rewards =
        RewardsOf(scenes, *objective_.reward, data_.furniture(), asset_set_);
    samples.reward = std::accumulate(rewards.begin(), rewards.end(), 0.0) / samples.scenes;
    for (const auto& one : scenes) {
      samples.furnished += (data_.furniture().Holds(one) ? 1.0 : 0.0) / samples.scenes;
      samples.objects += static_cast<double>(one.size()) / samples.scenes;
      samples.most_objects = std::max(samples.most_objects, static_cast<int>(one.size()));
    }
    samples.accuracy = data_.Accuracy(scenes, 10, request_.options.seed);
    Settle(scenes, name, &samples, finished, progress);
    return samples;
  }

 private:
  void Settle(const SampledScenes& scenes, const std::string& name, PostTrainingSamples* samples,
              SampledScenes* finished, core::Progress* progress) const {
    samples->settled = std::min(samples->scenes, request_.settled_scenes);
    std::vector<scene::FeasibleScene> feasible(static_cast<size_t>(samples->settled));
    progress->Stage("settling " + name, samples->settled);
    scene::FeasibilityOptions options;
    options.lowering = kSampleLowering;
    core::ParallelFor(samples->settled, [&](int i) {
      core::CheckCancelled();
      const auto at = static_cast<size_t>(i);
      feasible[at] = scene::MakeFeasible(scenes[at], asset_set_, options);
      progress->Advance();
    });
    for (scene::FeasibleScene& one : feasible) {
      const int kept = static_cast<int>(one.objects.size());
      const bool whole = one.valid && data_.furniture().Holds(one.objects);
      samples->valid += (whole ? 1.0 : 0.0) / samples->settled;
      samples->kept_objects += static_cast<double>(kept) / samples->settled;
      if (whole) samples->most_kept_objects = std::max(samples->most_kept_objects, kept);
      finished->push_back(std::move(one.objects));
    }
  }

  const ScenePostTrainingRequest& request_;
  const DataComparison& data_;
  const Objective& objective_;
  const scene::AssetSet& asset_set_;
};

void CountObjects(const scene::SceneDataset& data, int scenes, ScenePostTrainingReport* report) {
  constexpr int kBlock = 1024;  // scenes in memory at once
  const auto width = static_cast<size_t>(data.vocabulary().TokenWidth());
  const auto entries = static_cast<size_t>(data.vocabulary().entries);
  for (int first = 0; first < scenes; first += kBlock) {
    const std::vector<float> tokens = data.Read(first, std::min(kBlock, scenes - first));
    for (size_t scene = 0; scene < tokens.size(); scene += entries * width) {
      int count = 0;
      for (size_t i = 1; i <= entries; ++i) count += tokens[scene + i * width - 1] < 0.5f ? 1 : 0;
      report->data_objects += static_cast<double>(count) / scenes;
      report->data_most_objects = std::max(report->data_most_objects, count);
    }
  }
}

std::vector<ScenePair> PairsOf(const SampledScenes& before, const SampledScenes& after) {
  std::vector<ScenePair> pairs;
  for (size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (!before[i].empty() && !after[i].empty()) pairs.push_back({before[i], after[i]});
  }
  return pairs;
}

}  // namespace

ScenePostTrainingReport PostTrainScenes(const ScenePostTrainingRequest& request,
                                        core::Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  ValidatePostTraining(request);
  const fs::path weights =
      request.weights.empty() ? ShippedSceneWeights(request.type) : request.weights;
  const scene::SceneModelMetadata model = scene::ReadSceneModelMetadata(weights);
  const scene::SceneDataset data(request.data);
  if (data.vocabulary().categories != model.vocabulary.categories) {
    throw core::Error("the data has other categories than the model", request.data.string(),
                      "give the dataset that the model was trained on");
  }
  ScenePostTrainingReport report;
  report.output = request.output;
  report.continuous = model.options.continuous;
  report.largest_accuracy = request.largest_accuracy;
  const std::set<std::string> categories(model.vocabulary.categories.begin(),
                                         model.vocabulary.categories.end());
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(FoldersOfCategories(request.data, request.assets, categories));
  const Objective objective = ObjectiveOf(request, model, asset_set, &report.findings);
  report.objective = objective.reward->Name();
  const core::FolderLock lock(request.output, "a post-training");
  if (request.options.trainer.resume) {
    CheckPostTrainingSettings(request, weights);
  } else {
    RemovePostTraining(request.output);
  }
  const int scenes = model.training_scenes > 0 ? std::min(model.training_scenes, data.SceneCount())
                                               : data.SceneCount();
  CountObjects(data, scenes, &report);
  const DataComparison reference(data, model, asset_set, &report.findings, progress);
  const Comparison comparison(request, reference, objective, asset_set);
  SampledScenes before, after;
  report.before = comparison.Of(weights, "before", &before, progress);

  WritePostTrainingSettings(request, weights);
  steering::PostTrainingGoal goal;
  goal.rewards = [&](const SampledScenes& sampled) {
    return RewardsOf(sampled, *objective.reward, reference.furniture(), asset_set);
  };
  goal.accuracy = [&](const SampledScenes& sampled) {
    return reference.Accuracy(sampled, kQuickRuns, request.options.seed);
  };
  goal.largest_accuracy = request.largest_accuracy;
  goal.prompts = objective.prompts;
  goal.sizes = asset_set.Sizes();
  report.training =
      steering::PostTrain(weights, data, goal, request.options, request.output, progress);

  const steering::Checkpoint& chosen =
      report.training.checkpoints[static_cast<size_t>(report.training.chosen)];
  if (chosen.score.accuracy > request.largest_accuracy) {
    report.findings.push_back(
        {"no-checkpoint-like-data", core::Severity::kWarning, request.output.string(),
         "a classifier tells the samples of every checkpoint from data with more than the "
         "largest accuracy (fewer rounds, a lower --rate, or a larger --data-weight)"});
  }
  report.after = comparison.Of(request.output / scene::kWeightsFile, "after", &after, progress);
  progress->Stage("pictures");
  WriteBeforeAfter(PairsOf(before, after), asset_set, request.output);
  progress->Finish();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  core::WriteFile(request.output / "reward.svg", PostTrainingCurves(report));
  core::WriteFile(request.output / "report.json", PostTrainingJson(report));
  return report;
}

}  // namespace simwright::workflows
