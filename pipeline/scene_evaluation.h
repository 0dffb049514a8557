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

namespace simwright::pipeline {

struct SceneEvaluationRequest {
  // Of scene: with the shipped weights of that name (models/scenes/TYPE.pt), and held-out scenes
  // made by the grammar, unless `weights` or `data` say otherwise.
  std::string type;
  std::filesystem::path data;     // dataset; empty: `count` scenes are generated
  std::filesystem::path weights;  // of a model to sample from
  std::filesystem::path samples;  // what `scene sample --raw` wrote, instead of sampling
  // The first scenes of `data` are what the model learned from, the rest is held out. -1: as the
  // weights say where they learned from `data` (its seed), else none.
  int training_scenes = -1;
  int count = 1000;                           // scenes of each set, at most
  std::vector<std::filesystem::path> assets;  // folders, the first first; the library for the rest
  // A TorchScript module and the side of its pictures, instead of our features.
  std::filesystem::path features;
  int feature_side = 299;
  scene::SampleOptions sampling;
  std::filesystem::path output;  // folder of metrics.json and sheet.png; empty: none
  std::uint64_t seed = 1;
};

// How much things of a set's scenes are in each other, m (scene::TotalPenetration).
struct PenetrationSummary {
  double median = 0.0, mean = 0.0;          // of convex parts: MTP is the median
  double box_median = 0.0, box_mean = 0.0;  // of the bodies' boxes
};

// A set of scenes against the reference.
struct SceneSetMetrics {
  int scenes = 0;
  double mean_objects = 0.0;
  double divergence = 0.0;  // KL(reference || set), nats
  PenetrationSummary penetration;
  // Where there are features.
  std::optional<double> frechet;
  std::vector<scene::AccuracyScore> accuracy;
};

// Distances to the nearest training scene, m.
struct DistanceSummary {
  double mean = 0.0, least = 0.0, tenth = 0.0, median = 0.0, ninetieth = 0.0;
};

struct SceneEvaluation {
  std::string type;
  std::string features;  // their name; empty: none were found
  // What the others are compared with: held-out scenes, or training scenes where none are held out.
  int reference_scenes = 0;
  bool reference_is_held_out = true;
  PenetrationSummary reference_penetration;
  int training_scenes = 0;
  SceneSetMetrics samples;
  // Training scenes against held-out ones: what two sets of one kind differ by at this size.
  std::optional<SceneSetMetrics> training;
  scene::SceneDistanceOptions distance;
  std::optional<DistanceSummary> sample_distance, held_out_distance;  // where there is training
  double learning_rate = 0.0;                                         // of the classifier
  core::Findings findings;
  double seconds = 0.0;
};

// Samples scenes where none are given, compares them with held-out ones (docs/scenes.md says how),
// and writes metrics.json and sheet.png into the output, beside what had to be sampled (samples/)
// and generated (held_out/, which a later call goes on from). Throws core::Error where there is
// nothing to evaluate, sets are of different types, or something is damaged.
SceneEvaluation EvaluateScenes(const SceneEvaluationRequest& request, core::Progress* progress);

// As text for people, and as JSON.
std::string EvaluationTable(const SceneEvaluation& evaluation);
std::string EvaluationJson(const SceneEvaluation& evaluation);

}  // namespace simwright::pipeline
