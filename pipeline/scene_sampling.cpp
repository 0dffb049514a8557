#include "pipeline/scene_sampling.h"

#include <chrono>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "assets/asset.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "pipeline/scene_assets.h"
#include "pipeline/scene_shapes.h"
#include "pipeline/scene_sheet.h"
#include "pipeline/scene_weights.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

// The distance that objects are lowered, m: about one shelf spacing, so that an object between two
// boards comes down on the lower one; less than a table's height, so that an object beside it
// falls.
constexpr double kLowering = 0.25;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Sampled {
  scene::SceneAttempt attempt;
  std::vector<scene::DrawnObject> objects;
};

Sampled AsSampled(std::vector<scene::DrawnObject> objects) {
  Sampled sampled;
  const int count = static_cast<int>(objects.size());
  sampled.attempt = {count, count, 0, false, true, 0.0, 0.0, 0.0};
  sampled.objects = std::move(objects);
  return sampled;
}

Sampled Settled(const std::vector<scene::DrawnObject>& objects, const scene::Palette& palette) {
  scene::FeasibilityOptions options;
  options.lowering = kLowering;
  scene::FeasibleScene feasible = MakeFeasible(objects, palette, options);
  Sampled sampled;
  sampled.attempt = AttemptOf(feasible, static_cast<int>(objects.size()));
  sampled.objects = std::move(feasible.objects);
  return sampled;
}

std::vector<Sampled> Finish(const std::vector<float>& tokens, const scene::Vocabulary& vocabulary,
                            const scene::Palette& palette, bool raw, core::Progress* progress) {
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  std::vector<Sampled> scenes(tokens.size() / size);
  progress->Stage(raw ? "writing" : "settling", static_cast<int>(scenes.size()));
  core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
    core::CheckCancelled();
    const auto index = static_cast<size_t>(i);
    std::vector<scene::DrawnObject> objects = DecodeScene(&tokens[index * size], vocabulary);
    scenes[index] = raw ? AsSampled(std::move(objects)) : Settled(objects, palette);
    progress->Advance();
  });
  return scenes;
}

scene::ScenePart PartOf(const std::vector<Sampled>& scenes, const scene::Vocabulary& vocabulary,
                        const scene::PartOrigin& origin) {
  scene::ScenePart part{vocabulary, origin, {}, {}};
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  for (const Sampled& one : scenes) {
    part.attempts.push_back(one.attempt);
    if (!one.attempt.sound) continue;
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(one.objects, vocabulary, &part.tokens[part.tokens.size() - size]);
  }
  return part;
}

fs::path WeightsOf(const SceneSamplingRequest& request) {
  if (request.weights.empty() == request.type.empty()) {
    throw core::Error("give either weights or a scene type to sample from", "",
                      "name a weights file, or a --type with shipped weights");
  }
  return request.weights.empty() ? ShippedSceneWeights(request.type) : request.weights;
}

scene::PartOrigin OriginOf(const SceneSamplingRequest& request, const fs::path& weights) {
  nlohmann::ordered_json settings;
  settings["weights"] = core::ContentHash(core::ReadFile(weights));
  settings["steps"] = request.sampling.steps;
  settings["eta"] = request.sampling.eta;
  settings["raw"] = request.raw;
  if (!request.raw) settings["lowering"] = kLowering;
  return {request.sampling.seed, 0, "{}", settings.dump(), SIMWRIGHT_VERSION};
}

}  // namespace

SceneSamplingReport SampleScenes(const SceneSamplingRequest& request, core::Progress* progress) {
  if (request.count < 1) throw core::Error("at least 1 scene must be sampled", "--count");
  const fs::path weights = WeightsOf(request);
  scene::SceneModel model = scene::SceneModel::Load(weights);
  for (const auto& [slot, folder] : request.added) {
    if (assets::FileSafeName(slot) != slot) {
      throw core::Error("a category must be a valid folder name", slot);
    }
    model.AddAsset(slot, ShapeOfAsset(folder, model.facts().options.shape_points));
  }
  const scene::Vocabulary& vocabulary = model.facts().vocabulary;
  core::StagedFolder staged(request.output, request.force);
  core::Findings findings;
  const scene::Palette palette = scene::ReadPalette(GatherSceneAssets(
      {vocabulary.slots, request.added, request.assets, staged.staging() / "assets", &findings},
      progress));
  SceneSamplingReport report;
  report.output = request.output;
  report.raw = request.raw;
  progress->Stage("sampling", request.count);
  auto start = Clock::now();
  const std::vector<float> tokens = model.Sample(request.count, request.sampling, progress);
  report.sampling_seconds = SecondsSince(start);
  start = Clock::now();
  const std::vector<Sampled> scenes = Finish(tokens, vocabulary, palette, request.raw, progress);
  report.physics_seconds = SecondsSince(start);
  const scene::ScenePart part = PartOf(scenes, vocabulary, OriginOf(request, weights));
  scene::WritePart(part, staged.staging() / scene::PartName(0));
  report.statistics = StatisticsOf(part.attempts);
  report.statistics.type = vocabulary.type;
  report.statistics.findings = std::move(findings);
  if (!request.raw) {
    const core::Findings dropped = DroppedFindings(report.statistics);
    report.statistics.findings.insert(report.statistics.findings.end(), dropped.begin(),
                                      dropped.end());
  }
  core::WriteFile(staged.staging() / "statistics.json", StatisticsJson(report.statistics));
  WriteSceneSheet(scene::SceneDataset(staged.staging()), palette, staged.staging() / "scenes.png");
  progress->Finish();
  staged.Commit();
  return report;
}

std::string SamplingTable(const SceneSamplingReport& report) {
  char line[256];
  std::snprintf(line, sizeof line, "%s: sampled in %.1f s (%.1f scenes/s)", report.output.c_str(),
                report.sampling_seconds,
                report.statistics.attempts / std::max(1e-9, report.sampling_seconds));
  std::string text = line;
  if (!report.raw) {
    std::snprintf(line, sizeof line, ", physics in %.1f s", report.physics_seconds);
    text += line;
  }
  return text + "\n" + StatisticsTable(report.statistics);
}

std::string SamplingJson(const SceneSamplingReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(StatisticsJson(report.statistics));
  json["output"] = report.output.string();
  json["raw"] = report.raw;
  json["sampling_seconds"] = report.sampling_seconds;
  json["physics_seconds"] = report.physics_seconds;
  return json.dump(2) + "\n";
}

}  // namespace simwright::pipeline
