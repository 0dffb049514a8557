#include "workflows/scenes/scene_sets.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/json.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/prompt/prompt_drawing.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_generation.h"
#include "workflows/scenes/scene_prompts.h"
#include "workflows/scenes/scene_sampling.h"
#include "workflows/scenes/scene_weights.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

SceneSet Decoded(const scene::SceneDataset& dataset, int first, int count) {
  if (count == 0) return {};
  return DecodeScenes(dataset.Read(first, count), dataset.vocabulary());
}

// Returns the weights to sample from or to get the training scenes from; empty if none are needed.
fs::path SetWeights(const SceneEvaluationRequest& request) {
  if (!request.weights.empty()) return request.weights;
  if (!request.samples.empty()) return {};
  if (request.type.empty()) {
    throw core::Error("there is nothing to evaluate", "",
                      "give --samples, --model or a --type that has shipped weights");
  }
  return ShippedSceneWeights(request.type);
}

std::vector<fs::path> AssetFolders(const SceneEvaluationRequest& request, const fs::path& data) {
  std::vector<fs::path> folders = request.assets;
  for (const fs::path& one : {data / "assets", request.samples / "assets"}) {
    if (fs::is_directory(one)) folders.push_back(one);
  }
  return folders;
}

// Generates a dataset that our models were not trained on: with another seed than their data.
fs::path Generated(const SceneEvaluationRequest& request, const std::string& type,
                   std::uint64_t data_seed, const fs::path& folder, core::Progress* progress) {
  constexpr std::uint64_t kElsewhere = 1'000'003;
  SceneGenerationRequest generation;
  generation.type = type;
  generation.count = request.count;
  generation.seed = data_seed + kElsewhere + request.seed;
  generation.assets = request.assets;
  generation.output = folder / "held_out";
  GenerateScenes(generation, progress);
  return generation.output;
}

int TrainingScenes(const SceneEvaluationRequest& request, const scene::SceneDataset& data,
                   const std::optional<scene::SceneModelMetadata>& metadata,
                   core::Findings* findings) {
  const int there = data.SceneCount();
  if (request.training_scenes > there) {
    throw core::Error("the dataset has " + std::to_string(there) + " scenes", request.data.string(),
                      "--training-scenes cannot be more");
  }
  if (request.training_scenes >= 0) return request.training_scenes;
  if (request.data.empty() || !metadata) return 0;
  if (metadata->data_seed != data.parts().front().origin().seed) return 0;
  if (metadata->training_scenes > there) {
    findings->push_back({"scenes-missing", core::Severity::kWarning, request.data.string(),
                         "the model was trained on more scenes of this dataset than are present",
                         static_cast<double>(metadata->training_scenes)});
  }
  return std::min(there, metadata->training_scenes);
}

// Returns the prompts of held-out scenes `first` and following, stored or, for older datasets,
// drawn now.
std::vector<std::string> HeldOutPrompts(const scene::SceneDataset& data, int first, int count,
                                        const scene::CategorySizes& sizes) {
  if (count < 1) {
    throw core::Error("prompts come from held-out scenes, and there are none", "",
                      "hold scenes out, or leave --prompts out");
  }
  std::vector<std::string> prompts = data.ReadPrompts(first, count);
  if (!prompts.empty()) return prompts;
  const scene::PromptDrawing drawing(data.vocabulary(), sizes);
  const std::vector<float> tokens = data.Read(first, count);
  const size_t size = tokens.size() / static_cast<size_t>(count);
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    core::Rng rng = core::StreamRng(data.parts().front().origin().seed, i);
    prompts.push_back(drawing.Draw(&tokens[i * size], rng).Text());
  }
  return prompts;
}

void Sample(const SceneEvaluationRequest& request, const fs::path& weights, const std::string& type,
            const std::vector<fs::path>& assets, const std::vector<std::string>& prompts,
            const fs::path& output, core::Progress* progress) {
  SceneSamplingRequest sampling;
  sampling.weights = weights;
  sampling.type = type;
  sampling.count = request.count;
  sampling.output = output;
  sampling.assets = assets;
  sampling.sampling = request.sampling;
  sampling.prompts = prompts;
  sampling.free_counts = request.free_counts;
  sampling.text_encoder = request.text_encoder;
  sampling.raw = true;
  sampling.force = true;
  SampleScenes(sampling, progress);
}

// Returns the metadata of a model; of several types that of request.type, or of the data's.
scene::SceneModelMetadata EvaluatedMetadata(const SceneEvaluationRequest& request,
                                            const fs::path& weights) {
  const scene::SceneModelMetadata metadata = scene::ReadSceneModelMetadata(weights);
  if (metadata.types.empty()) return metadata;
  std::string type = request.type;
  if (type.empty() && !request.data.empty()) {
    type = scene::SceneDataset(request.data).vocabulary().type;
  }
  return metadata.OfType(type);
}

// Returns true if scenes of `one` can be compared with those of `other`: the same type, and no
// category that `other` lacks. A model of several types has the categories of all.
bool Comparable(const scene::Vocabulary& one, const scene::Vocabulary& other) {
  return one.type == other.type &&
         std::all_of(one.categories.begin(), one.categories.end(),
                     [&](const std::string& category) { return other.ClassOf(category) >= 0; });
}

// Warns if the samples are not the model's raw output.
void WarnOfPhysics(const scene::SceneDataset& samples, const fs::path& path,
                   core::Findings* findings) {
  const auto settings = core::TryParseJson(samples.parts().front().origin().settings);
  const core::Json* raw = settings ? core::FindMember(*settings, "raw") : nullptr;
  if (raw != nullptr && raw->is_boolean() && raw->get<bool>()) return;
  findings->push_back({"scenes-processed", core::Severity::kWarning, path.string(),
                       "these scenes are not a model's raw samples: their penetration was "
                       "resolved (sample with --raw)",
                       0.0});
}

}  // namespace

SceneSets GatherSceneSets(const SceneEvaluationRequest& request, const fs::path& folder,
                          core::Findings* findings, core::Progress* progress) {
  const fs::path weights = SetWeights(request);
  std::optional<scene::SceneModelMetadata> metadata;
  if (!weights.empty()) metadata = EvaluatedMetadata(request, weights);
  std::optional<scene::SceneDataset> samples;
  if (!request.samples.empty()) samples.emplace(request.samples);
  SceneSets sets;
  sets.vocabulary = samples ? samples->vocabulary() : metadata->vocabulary;
  const std::string& type = sets.vocabulary.type;
  if (!request.type.empty() && request.type != type) {
    throw core::Error("these are scenes of the type " + type, "--type " + request.type);
  }
  const fs::path data_folder =
      !request.data.empty()
          ? request.data
          : Generated(request, type, metadata ? metadata->data_seed : 0, folder, progress);
  const scene::SceneDataset data(data_folder);
  const std::vector<fs::path> assets = AssetFolders(request, data_folder);
  sets.asset_set = scene::ReadAssetSet(
      GatherSceneAssets({sets.vocabulary.categories, {}, assets, folder / "assets"}, progress));
  const int training = TrainingScenes(request, data, metadata, findings);
  const int held_out = std::min(request.count, data.SceneCount() - training);
  if (!samples) {
    std::vector<std::string> prompts;
    if (request.prompted) {
      prompts = HeldOutPrompts(data, training, held_out, sets.asset_set.Sizes());
    }
    Sample(request, weights, type, assets, prompts, folder / "samples", progress);
    samples.emplace(folder / "samples");
  } else {
    WarnOfPhysics(*samples, request.samples, findings);
  }
  if (!Comparable(data.vocabulary(), sets.vocabulary) ||
      !Comparable(samples->vocabulary(), sets.vocabulary)) {
    throw core::Error("data, samples and model have different scene types or categories",
                      data_folder.string());
  }
  sets.samples = Decoded(*samples, 0, std::min(request.count, samples->SceneCount()));
  sets.training = Decoded(data, 0, training);
  sets.held_out = Decoded(data, training, held_out);
  const auto sampled = static_cast<int>(sets.samples.size());
  const std::vector<std::string> prompts = samples->ReadPrompts(0, sampled);
  if (!prompts.empty()) {
    sets.prompts = ReadPrompts(prompts, {}, sets.vocabulary, findings);
    if (request.prompted) sets.prompted_scenes = sets.held_out;
  }
  return sets;
}

}  // namespace simwright::workflows
