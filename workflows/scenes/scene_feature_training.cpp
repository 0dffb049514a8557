#include "workflows/scenes/scene_feature_training.h"

#include <algorithm>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/shuffle.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_assets.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using Objects = std::vector<scene::SceneObject>;

constexpr double kLeftOut = 0.2, kMoved = 0.5;  // fractions of a perturbed scene's objects
constexpr double kFarthest = 0.3;               // m, the largest displacement along each axis

// Removes and displaces random objects, as a poor model would.
Objects Perturbed(const Objects& objects, core::Rng& rng) {
  Objects spoilt;
  for (const scene::SceneObject& object : objects) {
    if (core::Uniform(rng) < kLeftOut) continue;
    spoilt.push_back(object);
    if (core::Uniform(rng) >= kMoved) continue;
    for (int axis = 0; axis < 3; ++axis) {
      spoilt.back().world_from_object.translation()[axis] +=
          core::Uniform(rng, -kFarthest, kFarthest);
    }
  }
  return spoilt;
}

// Renders scenes 0 .. count - 1, each unchanged and perturbed.
template <typename SceneAt>
void Render(const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set, int count,
            std::uint64_t seed, const SceneAt& scene_at,
            std::vector<scene::CountedPicture>* pictures, core::Progress* progress) {
  const core::Camera camera = scene::LabelCamera(vocabulary.type);
  const size_t first = pictures->size();
  pictures->resize(first + 2 * static_cast<size_t>(count));
  progress->Stage("images of " + vocabulary.type, count);
  core::ParallelFor(count, [&](int i) {
    core::CheckCancelled();
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    const Objects objects = scene_at(i, rng);
    const size_t at = first + 2 * static_cast<size_t>(i);
    (*pictures)[at] = CountPicture(objects, vocabulary, asset_set, camera);
    (*pictures)[at + 1] = CountPicture(Perturbed(objects, rng), vocabulary, asset_set, camera);
    progress->Advance();
  });
}

// Renders the scenes of a dataset. `kept`: a folder for assets that are only needed here.
void RenderDataset(const fs::path& path, const SceneFeatureTrainingRequest& request,
                   const fs::path& kept, std::vector<scene::CountedPicture>* pictures,
                   core::Progress* progress) {
  const scene::SceneDataset dataset(path);
  const scene::Vocabulary& vocabulary = dataset.vocabulary();
  std::vector<fs::path> folders = request.assets;
  if (fs::is_directory(path / "assets")) folders.push_back(path / "assets");
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(GatherSceneAssets({vocabulary.categories, {}, folders, kept}, progress));
  const auto scenes = DecodeScenes(dataset.Read(0, dataset.SceneCount()), vocabulary);
  Render(
      vocabulary, asset_set, dataset.SceneCount(), request.options.seed,
      [&](int i, core::Rng&) { return scenes[static_cast<size_t>(i)]; }, pictures, progress);
}

void RenderDraws(const std::string& name, const SceneFeatureTrainingRequest& request,
                 const fs::path& kept, std::vector<scene::CountedPicture>* pictures,
                 core::Progress* progress) {
  const scene::SceneType& type = scene::SceneTypeNamed(name);
  const scene::Vocabulary vocabulary = VocabularyOf(type.make(scene::DefaultCategorySizes()));
  const scene::AssetSet asset_set = scene::ReadAssetSet(
      GatherSceneAssets({vocabulary.categories, {}, request.assets, kept}, progress));
  const scene::Grammar grammar = type.make(asset_set.Sizes());
  Render(
      vocabulary, asset_set, request.samples, request.options.seed,
      [&](int, core::Rng& rng) { return SampleGrammar(grammar, rng).objects; }, pictures, progress);
}

}  // namespace

fs::path FeatureWeights(const fs::path& models) {
  return models / "scene_features.pt";
}

scene::FeatureTrainingReport TrainSceneFeatures(const SceneFeatureTrainingRequest& request,
                                                core::Progress* progress) {
  if (request.samples < 1) throw core::Error("at least 1 scene must be sampled", "--draws");
  std::vector<std::string> types = request.types;
  if (types.empty() && request.datasets.empty()) {
    for (const scene::SceneType& type : scene::SceneTypes()) types.push_back(type.name);
  }
  const core::TemporaryFolder kept;
  std::vector<scene::CountedPicture> pictures;
  for (size_t i = 0; i < request.datasets.size(); ++i) {
    RenderDataset(request.datasets[i], request, kept.path() / ("dataset_" + std::to_string(i)),
                  &pictures, progress);
  }
  for (const std::string& name : types) {
    RenderDraws(name, request, kept.path() / "drawn", &pictures, progress);
  }
  // Shuffled, so that the held-out scenes are of all types.
  core::Rng rng = core::StreamRng(request.options.seed, 1);
  core::Shuffle(&pictures, rng);
  return scene::TrainFeatures(pictures, request.options, request.weights, progress);
}

}  // namespace simwright::workflows
