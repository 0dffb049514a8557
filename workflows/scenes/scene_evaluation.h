#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/metrics/classifier_accuracy.h"
#include "scene/metrics/scene_distance.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/prompt_evaluation.h"

namespace simwright::workflows {

struct SceneEvaluationRequest {
  // The scene type. Selects the shipped weights of that name (models/scenes/TYPE.pt) and held-out
  // scenes from the grammar, unless `weights` or `data` override them.
  std::string type;
  std::filesystem::path data;     // a dataset; empty: `count` scenes are generated
  std::filesystem::path weights;  // the weights of the model to sample from
  std::filesystem::path samples;  // output of `scene sample --raw`, instead of sampling
  // The number of leading scenes of `data` that are training scenes; the rest is held out. -1: the
  // number in the weights if they were trained on `data` (its seed), else none.
  int training_scenes = -1;
  int count = 1000;                           // the maximum number of scenes per set
  std::vector<std::filesystem::path> assets;  // searched in this order, then the library
  // A TorchScript feature extractor and the side of its input images, instead of our features.
  std::filesystem::path features;
  int feature_side = 299;
  scene::SampleOptions sampling;
  // True: the samples follow prompts, those of the held-out scenes, one each.
  bool prompted = false;
  bool free_counts = false;            // SceneSamplingRequest::free_counts
  std::filesystem::path text_encoder;  // of a model that was trained with an external one
  std::filesystem::path output;        // for metrics.json and sheet.png; empty: none
  std::uint64_t seed = 1;
};

// The interpenetration of a set's scenes, m (scene::TotalPenetration).
struct PenetrationSummary {
  double median = 0.0, mean = 0.0;          // between convex parts; MTP is the median
  double box_median = 0.0, box_mean = 0.0;  // between the bodies' bounding boxes
};

// The metrics of a set of scenes against the reference.
struct SceneSetMetrics {
  int scenes = 0;
  double mean_objects = 0.0;
  double divergence = 0.0;  // KL(reference || set), nats
  PenetrationSummary penetration;
  // Present if features are available.
  std::optional<double> frechet;
  std::vector<scene::AccuracyScore> accuracy;
};

// Distances to the nearest training scene, m.
struct DistanceSummary {
  double mean = 0.0, least = 0.0, tenth = 0.0, median = 0.0, ninetieth = 0.0;
};

struct SceneEvaluation {
  std::string type;
  std::string features;  // their name; empty: no features were found
  // The size of the reference set: held-out scenes, or training scenes if none are held out.
  int reference_scenes = 0;
  bool reference_is_held_out = true;
  PenetrationSummary reference_penetration;
  int training_scenes = 0;
  SceneSetMetrics samples;
  // Training scenes against held-out ones: the difference between two sets of one distribution at
  // this size.
  std::optional<SceneSetMetrics> training;
  scene::SceneDistanceOptions distance;
  std::optional<DistanceSummary> sample_distance, held_out_distance;  // with training scenes
  std::optional<PromptMetrics> prompts;  // of samples that have prompts
  double learning_rate = 0.0;            // the classifier's
  core::Findings findings;
  double seconds = 0.0;
};

// Samples scenes if none are given, compares them with held-out ones (docs/scenes.md), and writes
// metrics.json and sheet.png into the output, beside the scenes it sampled (samples/) and generated
// (held_out/, from which a later call resumes). Throws core::Error if there is nothing to evaluate,
// the sets are of different types, or a file is damaged.
SceneEvaluation EvaluateScenes(const SceneEvaluationRequest& request, core::Progress* progress);

// Format the evaluation as text for people and as JSON.
std::string EvaluationTable(const SceneEvaluation& evaluation);
std::string EvaluationJson(const SceneEvaluation& evaluation);

}  // namespace simwright::workflows
