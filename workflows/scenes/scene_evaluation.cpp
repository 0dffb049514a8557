#include "workflows/scenes/scene_evaluation.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>

#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "core/parallel.h"
#include "scene/export/scene_picture.h"
#include "scene/metrics/asset_frequency.h"
#include "scene/metrics/frechet.h"
#include "scene/metrics/label_render.h"
#include "scene/metrics/penetration.h"
#include "workflows/scenes/scene_set_features.h"
#include "workflows/scenes/scene_sets.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kFewest = 4;               // the minimum size of a set: two halves of two scenes
constexpr double kPublishedRate = 1e-4;  // of the classifier, for a user's network

void ValidateEvaluation(const SceneEvaluationRequest& request) {
  if (request.count < kFewest) throw core::Error("at least 4 scenes are compared", "--count");
  if (request.training_scenes < -1) {
    throw core::Error("the number of scenes must be at least 0", "--training-scenes");
  }
}

std::optional<scene::SceneFeatures> FindFeatures(const SceneEvaluationRequest& request,
                                                 core::Findings* findings) {
  if (!request.features.empty()) {
    return scene::SceneFeatures::LoadTorchScript(request.features, request.feature_side);
  }
  return ShippedSceneFeatures(findings);
}

double Quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  const double along = at - static_cast<double>(below);
  return (1.0 - along) * values[below] + along * values[above];
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Calls body for each scene from several threads.
void ForEach(const SceneSet& set, core::Progress* progress,
             const std::function<void(size_t)>& body) {
  core::ParallelFor(static_cast<int>(set.size()), [&](int i) {
    core::CheckCancelled();
    body(static_cast<size_t>(i));
    progress->Advance();
  });
}

class Evaluation {
 public:
  Evaluation(const SceneEvaluationRequest& request, const SceneSets& sets,
             const std::optional<scene::SceneFeatures>& features, core::Progress* progress)
      : request_(request), sets_(sets), features_(features), progress_(progress) {
    const bool held_out = static_cast<int>(sets.held_out.size()) >= kFewest;
    const SceneSet& training = sets.training;
    const auto some = std::min(training.size(), static_cast<size_t>(request.count));
    some_training_.assign(training.begin(), training.begin() + static_cast<std::ptrdiff_t>(some));
    reference_ = held_out ? &sets.held_out : &some_training_;
    if (std::min(reference_->size(), sets.samples.size()) < static_cast<size_t>(kFewest)) {
      throw core::Error("at least 4 samples are compared with at least 4 scenes",
                        std::to_string(sets.samples.size()) + " samples, " +
                            std::to_string(reference_->size()) + " scenes");
    }
    result_.type = sets.vocabulary.type;
    result_.features = features ? features->name() : "";
    result_.reference_is_held_out = held_out;
    result_.reference_scenes = static_cast<int>(reference_->size());
    result_.training_scenes = static_cast<int>(training.size());
    result_.learning_rate = features && features->own() ? kOwnFeaturesRate : kPublishedRate;
  }

  SceneEvaluation Run() {
    reference_counts_ = AssetCounts(*reference_, sets_.vocabulary);
    if (features_) reference_features_ = FeaturesOf(*reference_, "held-out scenes");
    result_.reference_penetration = PenetrationOf(*reference_);
    result_.samples = Compared(sets_.samples, "samples");
    if (result_.reference_is_held_out && some_training_.size() >= static_cast<size_t>(kFewest)) {
      result_.training = Compared(some_training_, "training scenes");
    }
    if (!sets_.training.empty()) CompareDistances();
    if (!sets_.prompts.empty()) {
      result_.prompts = MeasurePrompts(sets_.prompts, sets_.samples, sets_.prompted_scenes,
                                       sets_.asset_set.Sizes(), progress_);
    }
    return std::move(result_);
  }

 private:
  scene::FeatureMatrix FeaturesOf(const SceneSet& set, const std::string& name) {
    progress_->Stage("images of " + name, static_cast<int>(set.size()));
    return FeaturesOfScenes(set, sets_.vocabulary, sets_.asset_set, *features_, progress_);
  }

  PenetrationSummary PenetrationOf(const SceneSet& set) {
    std::vector<double> parts(set.size()), boxes(set.size());
    progress_->Stage("penetration", static_cast<int>(set.size()));
    ForEach(set, progress_, [&](size_t i) {
      parts[i] = TotalPenetration(set[i], sets_.asset_set, scene::BodyShape::kParts);
      boxes[i] = TotalPenetration(set[i], sets_.asset_set, scene::BodyShape::kBox);
    });
    return {Quantile(parts, 0.5), Mean(parts), Quantile(boxes, 0.5), Mean(boxes)};
  }

  SceneSetMetrics Compared(const SceneSet& set, const std::string& name) {
    SceneSetMetrics metrics;
    metrics.scenes = static_cast<int>(set.size());
    size_t objects = 0;
    for (const auto& scene : set) objects += scene.size();
    metrics.mean_objects = static_cast<double>(objects) / static_cast<double>(set.size());
    metrics.divergence =
        scene::FrequencyDivergence(reference_counts_, AssetCounts(set, sets_.vocabulary));
    metrics.penetration = PenetrationOf(set);
    if (!features_) return metrics;
    const scene::FeatureMatrix features = FeaturesOf(set, name);
    metrics.frechet =
        FrechetDistance(scene::GaussianOf(reference_features_), scene::GaussianOf(features));
    scene::AccuracyOptions options;
    options.seed = request_.seed;
    options.standardise = features_->own();
    options.learning_rate = result_.learning_rate;
    progress_->Stage("classifier");
    metrics.accuracy = ClassifierAccuracy(reference_features_, features, options);
    return metrics;
  }

  void CompareDistances() {
    const scene::SceneDistances distances(sets_.training, sets_.vocabulary, result_.distance);
    result_.sample_distance = Summary(distances, sets_.samples);
    if (result_.reference_is_held_out) {
      result_.held_out_distance = Summary(distances, sets_.held_out);
    }
  }

  DistanceSummary Summary(const scene::SceneDistances& distances, const SceneSet& set) {
    std::vector<double> nearest(set.size());
    progress_->Stage("nearest training scenes", static_cast<int>(set.size()));
    ForEach(set, progress_, [&](size_t i) { nearest[i] = distances.Nearest(set[i]).distance; });
    return {Mean(nearest), Quantile(nearest, 0.0), Quantile(nearest, 0.1), Quantile(nearest, 0.5),
            Quantile(nearest, 0.9)};
  }

  const SceneEvaluationRequest& request_;
  const SceneSets& sets_;
  const std::optional<scene::SceneFeatures>& features_;
  core::Progress* progress_;
  SceneSet some_training_;
  const SceneSet* reference_ = nullptr;
  std::vector<std::int64_t> reference_counts_;
  scene::FeatureMatrix reference_features_;
  SceneEvaluation result_;
};

// Writes one row per pair: a sample as a label render and from the side, then a held-out scene
// likewise.
void WriteSheet(const SceneSets& sets, const fs::path& path) {
  constexpr size_t kRows = 6;
  constexpr int kHeight = 300, kWidth = 400;  // pixels
  const SceneSet& data = sets.held_out.empty() ? sets.training : sets.held_out;
  const core::Camera camera = scene::LabelCamera(sets.vocabulary.type);
  std::vector<core::Image> pictures;
  for (size_t i = 0; i < std::min({kRows, sets.samples.size(), data.size()}); ++i) {
    for (const auto* scene : {&sets.samples[i], &data[i]}) {
      pictures.push_back(core::Resize(LabelRender(*scene, sets.vocabulary, sets.asset_set, camera),
                                      kWidth, kHeight));
      pictures.push_back(scene->empty() ? core::Image(kHeight, kHeight, 3, 255)
                                        : RenderFromSide(*scene, sets.asset_set, kHeight));
    }
  }
  core::WritePng(path, core::ContactSheet(pictures, 4));
}

}  // namespace

SceneEvaluation EvaluateScenes(const SceneEvaluationRequest& request, core::Progress* progress) {
  ValidateEvaluation(request);
  const auto start = std::chrono::steady_clock::now();
  core::Findings findings;
  const std::optional<scene::SceneFeatures> features = FindFeatures(request, &findings);
  const core::TemporaryFolder temporary;
  const fs::path folder = request.output.empty() ? temporary.path() : request.output;
  fs::create_directories(folder);
  const SceneSets sets = GatherSceneSets(request, folder, &findings, progress);
  SceneEvaluation evaluation = Evaluation(request, sets, features, progress).Run();
  evaluation.findings = findings;
  if (!request.output.empty()) {
    progress->Stage("sheet");
    WriteSheet(sets, folder / "sheet.png");
  }
  progress->Finish();
  evaluation.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!request.output.empty()) {
    core::WriteFile(folder / "metrics.json", EvaluationJson(evaluation));
  }
  return evaluation;
}

}  // namespace simwright::workflows
