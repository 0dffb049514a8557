#include "workflows/scenes/scene_sampling.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>

#include "assets/asset.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "core/parallel.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_shapes.h"
#include "workflows/scenes/scene_sheet.h"
#include "workflows/scenes/scene_source.h"
#include "workflows/scenes/scene_type_choice.h"
#include "workflows/scenes/scene_weights.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

double SamplingSeconds(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Sampled {
  scene::SceneAttempt attempt;
  std::vector<scene::SceneObject> objects;
};

std::vector<std::vector<scene::SceneObject>> ObjectsOf(const std::vector<Sampled>& scenes) {
  std::vector<std::vector<scene::SceneObject>> objects;
  for (const Sampled& one : scenes) objects.push_back(one.objects);
  return objects;
}

// Returns 1 for each scene that is kept.
std::vector<char> ValidOf(const std::vector<Sampled>& scenes) {
  std::vector<char> valid;
  for (const Sampled& one : scenes) valid.push_back(one.attempt.valid);
  return valid;
}

Sampled AsSampled(std::vector<scene::SceneObject> objects) {
  Sampled sampled;
  const int count = static_cast<int>(objects.size());
  sampled.attempt = {count, count, 0, false, true, 0.0, 0.0, 0.0};
  sampled.objects = std::move(objects);
  return sampled;
}

// Returns the number of objects that a prompt asks for; -1 if it leaves that open.
int AskedObjects(const scene::Prompt& prompt) {
  if (prompt.count) return *prompt.count;
  if (prompt.kind == scene::PromptKind::kEmpty || prompt.and_others) return -1;
  int asked = 0;
  for (const scene::NamedCount& one : prompt.names) asked += one.count;
  return asked;
}

Sampled Settled(const std::vector<scene::SceneObject>& objects, const scene::AssetSet& asset_set,
                const scene::Prompt& prompt) {
  scene::FeasibilityOptions options;
  options.prompt = prompt;
  options.lowering = kSampleLowering;
  if (const int asked = AskedObjects(prompt); asked >= 0) {
    options.min_objects = std::min(options.min_objects, asked);
  }
  scene::FeasibleScene feasible = MakeFeasible(objects, asset_set, options);
  Sampled sampled;
  sampled.attempt = AttemptOf(feasible, static_cast<int>(objects.size()));
  sampled.objects = std::move(feasible.objects);
  return sampled;
}

std::vector<Sampled> FinishScenes(const std::vector<float>& tokens,
                                  const scene::Vocabulary& vocabulary,
                                  const scene::AssetSet& asset_set,
                                  const std::vector<scene::Prompt>& prompts, bool raw,
                                  core::Progress* progress) {
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  std::vector<Sampled> scenes(tokens.size() / size);
  progress->Stage(raw ? "writing" : "settling", static_cast<int>(scenes.size()));
  core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
    core::CheckCancelled();
    const auto index = static_cast<size_t>(i);
    std::vector<scene::SceneObject> objects = DecodeScene(&tokens[index * size], vocabulary);
    const scene::Prompt prompt =
        prompts.empty() ? scene::Prompt() : prompts[index % prompts.size()];
    scenes[index] = raw ? AsSampled(std::move(objects)) : Settled(objects, asset_set, prompt);
    progress->Advance();
  });
  return scenes;
}

scene::SceneShard PartOf(const std::vector<Sampled>& scenes, const scene::Vocabulary& vocabulary,
                         const std::vector<std::string>& prompts,
                         const scene::ShardOrigin& origin) {
  scene::SceneShard part{vocabulary, origin, {}, {}, {}};
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  for (size_t i = 0; i < scenes.size(); ++i) {
    const Sampled& one = scenes[i];
    part.attempts.push_back(one.attempt);
    if (!one.attempt.valid) continue;
    if (!prompts.empty()) part.prompts.push_back(prompts[i % prompts.size()]);
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(one.objects, vocabulary, &part.tokens[part.tokens.size() - size]);
  }
  return part;
}

fs::path SamplingWeights(const SceneSamplingRequest& request) {
  if (!request.weights.empty()) return request.weights;
  if (!request.type.empty()) return ShippedWeightsForType(request.type);
  if (!request.prompts.empty() || !request.prompt_file.empty()) return ShippedTextWeights();
  throw core::Error("give weights, a scene type or a prompt to sample from", "",
                    "name a weights file, a --type with shipped weights, or a --prompt");
}

scene::ShardOrigin OriginOf(const SceneSamplingRequest& request,
                            const std::vector<std::string>& prompts, const fs::path& weights) {
  core::OrderedJson settings;
  settings["weights"] = core::ContentHash(core::ReadFile(weights));
  settings["steps"] = request.sampling.steps;
  settings["eta"] = request.sampling.eta;
  settings["raw"] = request.raw;
  if (!prompts.empty()) {
    settings["guidance"] = request.sampling.guidance;
    settings["prompts"] = prompts;
    settings["counts_held"] = !request.sampling.limits.empty();
  }
  if (!request.raw) settings["lowering"] = kSampleLowering;
  return {request.sampling.seed, 0, "{}", core::JsonLine(settings), SIMWRIGHT_VERSION};
}

// Loads the model and adds the requested assets to it.
scene::SceneModel LoadWithAssets(const SceneSamplingRequest& request, const fs::path& weights,
                                 const std::string& type) {
  scene::SceneModel model = scene::SceneModel::Load(weights, request.text_encoder, type);
  for (const auto& [category, folder] : request.added) {
    if (assets::FileSafeName(category) != category) {
      throw core::Error("a category must be a valid folder name", category);
    }
    model.AddAsset(category, ShapeOfAsset(folder, model.metadata().options.shape_points));
  }
  return model;
}

void ValidateSampling(const SceneSamplingRequest& request) {
  if (request.count < 1) {
    throw core::Error("at least 1 scene must be sampled", "--count", "ask for one or more");
  }
  std::string error;
  if (!request.sampling.IsValid(&error)) throw core::Error("sampling: " + error);
  for (const fs::path& folder : request.assets) RefuseOutputOver(folder, request.output);
  for (const auto& [category, folder] : request.added) RefuseOutputOver(folder, request.output);
}

// Returns the vocabulary of the categories that samples have, in their order; all if they have no
// objects.
scene::Vocabulary UsedVocabulary(const std::vector<float>& tokens,
                                 const scene::Vocabulary& vocabulary) {
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  std::set<std::string> used;
  for (size_t at = 0; at < tokens.size(); at += size) {
    for (const scene::SceneObject& object : DecodeScene(&tokens[at], vocabulary)) {
      used.insert(object.category);
    }
  }
  scene::Vocabulary some{vocabulary.type, vocabulary.entries, {}, {}};
  for (size_t c = 0; c < vocabulary.categories.size(); ++c) {
    if (used.count(vocabulary.categories[c]) == 0) continue;
    some.categories.push_back(vocabulary.categories[c]);
    some.welded.push_back(vocabulary.welded[c]);
  }
  return some.categories.empty() ? vocabulary : some;
}

void CheckSteps(int steps, const scene::SceneModelMetadata& metadata) {
  const int most = metadata.options.diffusion_steps;
  if (steps <= most) return;
  throw core::Error("the model samples in 1 to " + std::to_string(most) + " steps", "--steps",
                    "ask for fewer, or 0 for all");
}

// Throws core::Error if physics has left no scene.
void RefuseNoScenes(const SceneStatistics& statistics, const fs::path& output) {
  if (statistics.scenes > 0) return;
  throw core::Error("none of the " + std::to_string(statistics.attempts) +
                        " sampled scenes has enough objects left after physics",
                    output.string(), "give more --steps or --count, or --raw to see the samples");
}

SceneStatistics StatisticsWith(core::Findings findings, const scene::SceneShard& part,
                               const SceneSamplingRequest& request) {
  SceneStatistics statistics = StatisticsOf(part.attempts);
  RefuseNoScenes(statistics, request.output);
  statistics.type = part.vocabulary.type;
  statistics.physics = !request.raw;
  statistics.findings = std::move(findings);
  if (request.raw) return statistics;
  const core::Findings dropped = DroppedFindings(statistics);
  statistics.findings.insert(statistics.findings.end(), dropped.begin(), dropped.end());
  return statistics;
}

// Sets what makes a model follow prompts: their words, if it reads any, and the counts. Throws
// core::Error if neither can be.
void FollowPrompts(const std::vector<scene::Prompt>& prompts, const scene::SceneModelOptions& model,
                   const scene::Vocabulary& vocabulary, const fs::path& weights,
                   SceneSamplingRequest* request, core::Findings* findings) {
  if (prompts.empty()) return;
  const bool held = !request->free_counts && !model.continuous;
  if (!model.text && !held) {
    throw core::Error("the model reads no prompts", weights.string(), "train one with --text");
  }
  if (model.text) {
    request->sampling.prompts = TextsOf(prompts);
  } else {
    findings->push_back({"prompt-counts-only", core::Severity::kWarning, weights.string(),
                         "the model reads no prompts: of a prompt only the counts are held, and "
                         "its relations where physics can (train a model with --text)"});
  }
  if (!held) return;
  for (const scene::Prompt& prompt : prompts) {
    request->sampling.limits.push_back(scene::ClassLimitsOf(prompt, vocabulary));
  }
}

}  // namespace

SceneSamplingReport SampleScenes(const SceneSamplingRequest& wanted, core::Progress* progress) {
  ValidateSampling(wanted);
  const fs::path weights = SamplingWeights(wanted);
  const scene::SceneModelMetadata metadata = scene::ReadSceneModelMetadata(weights);
  CheckSceneType(metadata, wanted.type, weights);
  CheckSteps(wanted.sampling.steps, metadata);
  core::Findings findings;
  SceneSamplingRequest request = wanted;
  const RequestedPrompts requested = ReadPromptsAndTypes(
      request.prompts, request.prompt_file, metadata.vocabulary, TypesToRead(metadata), &findings);
  const std::vector<scene::Prompt>& prompts = requested.prompts;
  const scene::SceneModel model = LoadWithAssets(
      request, weights, ChooseSceneType(metadata, request.type, requested, &findings));
  const scene::Vocabulary& vocabulary = model.metadata().vocabulary;
  const std::vector<std::string> texts = TextsOf(prompts);
  FollowPrompts(prompts, metadata.options, vocabulary, weights, &request, &findings);
  core::StagedFolder staged(request.output, request.force);
  const auto gather = [&](const scene::Vocabulary& some) {
    return scene::ReadAssetSet(GatherSceneAssets(
        {some.categories, request.added, request.assets, staged.staging() / "assets", &findings},
        progress));
  };
  // A model of several types knows many categories, whose assets would take minutes to make: only
  // those that its samples have are made. The user's folders are read before, for their errors.
  const bool several = !metadata.types.empty();
  scene::AssetSet asset_set;
  if (!several) asset_set = gather(vocabulary);
  for (const fs::path& folder : request.assets) {
    if (several) scene::FoldersForCategories(folder, vocabulary.categories);
  }
  SceneSamplingReport report;
  report.output = request.output;
  report.raw = request.raw;
  progress->Stage("sampling", request.count);
  auto start = Clock::now();
  const std::vector<float> tokens = model.Sample(request.count, request.sampling, progress);
  report.sampling_seconds = SamplingSeconds(start);
  const scene::Vocabulary written = several ? UsedVocabulary(tokens, vocabulary) : vocabulary;
  if (several) asset_set = gather(written);
  start = Clock::now();
  const std::vector<Sampled> scenes =
      FinishScenes(tokens, vocabulary, asset_set, prompts, request.raw, progress);
  report.physics_seconds = SamplingSeconds(start);
  const scene::SceneShard part = PartOf(scenes, written, texts, OriginOf(request, texts, weights));
  report.prompts = ReportsOf(prompts, ObjectsOf(scenes), asset_set.Sizes(), ValidOf(scenes));
  scene::WriteShard(part, staged.staging() / scene::ShardName(0));
  report.statistics = StatisticsWith(std::move(findings), part, request);
  core::WriteFile(staged.staging() / "statistics.json", StatisticsJson(report.statistics));
  WriteSceneSheet(scene::SceneDataset(staged.staging()), asset_set,
                  staged.staging() / "scenes.png");
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
  return text + "\n" + PromptTable(report.prompts) + StatisticsTable(report.statistics);
}

std::string SamplingJson(const SceneSamplingReport& report) {
  core::OrderedJson json =
      core::ParseOrderedJson(StatisticsJson(report.statistics), "the statistics");
  json["output"] = report.output.string();
  json["raw"] = report.raw;
  if (!report.prompts.empty()) json["prompts"] = PromptJson(report.prompts);
  json["sampling_seconds"] = report.sampling_seconds;
  json["physics_seconds"] = report.physics_seconds;
  return core::JsonText(json);
}

}  // namespace simwright::workflows
