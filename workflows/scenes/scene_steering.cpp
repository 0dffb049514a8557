#include "workflows/scenes/scene_steering.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <set>
#include <tuple>

#include "core/content_hash.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/metrics/penetration.h"
#include "workflows/scenes/before_after.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_sampling.h"
#include "workflows/scenes/scene_type_choice.h"
#include "workflows/scenes/scene_weights.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

void ValidateSteering(const SceneSteeringRequest& request) {
  if (request.attempts < 1 || request.attempts > 100) {
    throw core::Error("the number of attempts must be 1 to 100", "--attempts");
  }
  if (request.candidates < 1 || request.candidates > 100) {
    throw core::Error("the number of candidates must be 1 to 100", "--candidates");
  }
  if (request.goal.count == 0 || request.goal.count < -1) {
    throw core::Error("at least 1 object must be added", "--count");
  }
}

fs::path SteeringWeights(const SceneSteeringRequest& request, const SceneSource& source) {
  if (!request.weights.empty()) return request.weights;
  const std::string& type = request.type.empty() ? source.type : request.type;
  if (type.empty()) {
    throw core::Error("the scene does not record its type", request.scene.string(),
                      "name a --type with shipped weights, or a --model");
  }
  return ShippedWeightsForType(type);
}

// Merges the notes on added references that say the same of many scenes into one, at the first of
// these scenes. Other findings are about one object each and stay as they are.
void MergeReferenceNotes(core::Findings* findings) {
  core::Findings merged;
  std::vector<int> scenes;
  for (const core::Finding& finding : *findings) {
    size_t same = finding.code == kReferenceAdded ? 0 : merged.size();
    while (same < merged.size() &&
           (merged[same].code != finding.code || merged[same].sentence != finding.sentence)) {
      ++same;
    }
    if (same < merged.size()) {
      ++scenes[same];
      continue;
    }
    merged.push_back(finding);
    scenes.push_back(1);
  }
  for (size_t i = 0; i < merged.size(); ++i) {
    if (scenes[i] == 1) continue;
    merged[i].place += " (and so in " + std::to_string(scenes[i]) + " scenes in all)";
  }
  *findings = std::move(merged);
}

// Steers the scenes of one source, round by round.
class SceneSteering {
 public:
  SceneSteering(const SceneSteeringRequest& request, core::Progress* progress)
      : request_(request),
        progress_(progress),
        source_(ReadSceneSource(request.scene, request.scenes, request.assets)),
        weights_(SteeringWeights(request, source_)),
        model_(LoadModel()),
        goal_(request.goal),
        source_assets_(&vocabulary()) {
    RefuseOutputOver(request.scene, request.output);
    report_.output = request.output;
    report_.rearrange = request.goal.rearrange;
    options_.feasibility.lowering = kSampleLowering;
    if (!request.prompt.empty()) {
      SetGoalFromPrompt(request.prompt, vocabulary(), &goal_, &report_.findings);
    }
    for (const SourceScene& one : source_.scenes) {
      scenes_.emplace_back(one, goal_, model_.metadata(), &source_assets_, &report_.findings);
    }
    MergeReferenceNotes(&report_.findings);
    reports_.resize(scenes_.size());
  }

  SceneSteeringReport Run() {
    core::StagedFolder staged(request_.output, request_.force);
    for (const auto& [key, folder] : source_assets_.folders()) wanted_.insert(key);
    GatherAssets(staged.staging() / "assets");
    for (int round = 0; round < request_.attempts && !Unfinished().empty(); ++round) {
      const std::vector<std::vector<Proposal>> proposals = Propose(round);
      GatherAssets(staged.staging() / "assets");
      strict_ = round + 1 < request_.attempts;
      TakeBest(Unfinished(), proposals);
      if (goal_.count < 0 && !goal_.rearrange) break;  // the model's choice
    }
    if (request_.goal.rearrange) ReturnMissing();
    FinishReports();
    Write(staged.staging());
    progress_->Finish();
    staged.Commit();
    return std::move(report_);
  }

 private:
  const scene::Vocabulary& vocabulary() const { return model_.metadata().vocabulary; }

  scene::SceneModel LoadModel() {
    const core::ScopedTimer timer(&report_.model_seconds);
    const scene::SceneModelMetadata metadata = scene::ReadSceneModelMetadata(weights_);
    CheckSceneType(metadata, request_.type, weights_);
    std::string type = request_.type;
    if (!metadata.types.empty() && type.empty()) type = source_.type;
    return scene::SceneModel::Load(weights_, request_.text_encoder, type);
  }

  std::vector<size_t> Unfinished() const {
    std::vector<size_t> open;
    for (size_t i = 0; i < scenes_.size(); ++i) {
      const bool first = reports_[i].attempts == 0;
      if (first || scenes_[i].Missing() > 0) open.push_back(i);
    }
    return open;
  }

  // Samples the proposals of a round, by unfinished scene.
  std::vector<std::vector<Proposal>> Propose(int round) {
    const core::ScopedTimer timer(&report_.sampling_seconds);
    const std::vector<size_t> open = Unfinished();
    std::vector<float> tokens;
    scene::InpaintingMask mask;
    scene::SampleOptions sampling = request_.sampling;
    const bool prompted = model_.metadata().options.text && !goal_.names.empty();
    for (const size_t i : open) {
      for (int c = 0; c < request_.candidates; ++c) {
        scenes_[i].AppendProposal(&tokens, &mask);
        if (prompted) sampling.prompts.push_back(scenes_[i].PromptText());
      }
    }
    sampling.seed = core::StreamRng(request_.sampling.seed, static_cast<std::uint64_t>(round))();
    progress_->Stage("sampling", static_cast<int>(open.size()) * request_.candidates);
    const std::vector<float> sampled = model_.Inpaint(tokens, mask, sampling, progress_);
    const auto size = static_cast<size_t>(vocabulary().entries * vocabulary().TokenWidth());
    std::vector<std::vector<Proposal>> proposals(open.size());
    for (size_t i = 0; i < open.size(); ++i) {
      for (int c = 0; c < request_.candidates; ++c) {
        const size_t at = i * static_cast<size_t>(request_.candidates) + static_cast<size_t>(c);
        proposals[i].push_back(scenes_[open[i]].Proposed(&sampled[at * size]));
        for (const ProposedObject& one : proposals[i].back()) wanted_.insert(one.object.category);
      }
    }
    return proposals;
  }

  // Reads the assets that are wanted and not yet there, and copies them into `folder`.
  void GatherAssets(const fs::path& folder) {
    const core::ScopedTimer timer(&report_.asset_seconds);
    SceneAssetsRequest missing;
    for (const std::string& category : wanted_) {
      if (asset_set_.Has(category)) continue;
      missing.categories.push_back(category);
      const auto own = source_assets_.folders().find(category);
      if (own != source_assets_.folders().end()) missing.chosen.insert(*own);
    }
    if (missing.categories.empty()) return;
    for (const fs::path& one : {request_.assets, source_.assets}) {
      if (fs::is_directory(one)) missing.folders.push_back(one);
    }
    missing.kept = folder;
    const scene::AssetSet gathered = scene::ReadAssetSet(GatherSceneAssets(missing, progress_));
    for (const std::string& category : missing.categories) {
      const scene::SceneAsset& asset = gathered.At(category);
      asset_set_.Add(category, asset.body, asset.visual);
    }
    sizes_ = asset_set_.Sizes();
  }

  // The physics of a scene's proposals in a round, the least penetrating proposal first.
  struct Trial {
    std::vector<size_t> order;  // of the proposals
    std::vector<scene::ConstrainedScene> placed;
    std::vector<int> broken;  // statements that do not hold, by rank
    // The first rank at which nothing was dropped and all statements hold.
    std::atomic<size_t> success{SIZE_MAX};
  };

  // Places the proposals of the `open` scenes and accepts the best of each. Proposals after the
  // first that loses nothing are not needed; which one that is does not depend on the threads.
  void TakeBest(const std::vector<size_t>& open, const std::vector<std::vector<Proposal>>& all) {
    const core::ScopedTimer timer(&report_.physics_seconds);
    std::vector<Trial> trials(open.size());
    std::vector<std::pair<size_t, size_t>> jobs;  // ranks of scenes
    for (size_t i = 0; i < open.size(); ++i) {
      trials[i].order = ByPenetration(scenes_[open[i]], all[i]);
      trials[i].placed.resize(all[i].size());
      trials[i].broken.resize(all[i].size());
      for (size_t rank = 0; rank < all[i].size(); ++rank) jobs.emplace_back(rank, i);
    }
    std::sort(jobs.begin(), jobs.end());
    progress_->Stage("settling", static_cast<int>(jobs.size()));
    core::ParallelFor(static_cast<int>(jobs.size()), [&](int job) {
      core::CheckCancelled();
      const auto [rank, i] = jobs[static_cast<size_t>(job)];
      if (trials[i].success > rank) {
        TryProposal(scenes_[open[i]], all[i][trials[i].order[rank]], rank, &trials[i]);
      }
      progress_->Advance();
    });
    core::ParallelFor(static_cast<int>(open.size()), [&](int job) {
      const auto i = static_cast<size_t>(job);
      AcceptBest(open[i], all[i], trials[i]);
    });
  }

  // Accepts the best proposal of a scene, and from the others what is still missing.
  void AcceptBest(size_t index, const std::vector<Proposal>& proposals, const Trial& trial) {
    SteeredScene& scene = scenes_[index];
    const size_t best = BestRank(trial), there = scene.After().size();
    scene.Accept(trial.placed[best], proposals[trial.order[best]]);
    ++reports_[index].attempts;
    for (size_t rank = 0; rank < trial.placed.size() && scene.Missing() > 0; ++rank) {
      core::CheckCancelled();
      if (rank == best) continue;
      const Proposal rest =
          scene.StillMissing(proposals[trial.order[rank]], trial.placed[rank], there);
      if (rest.empty()) continue;
      const scene::ConstrainedScene placed = scene.Place(rest, asset_set_, options_, strict_);
      if (placed.stable) scene.Accept(placed, rest);
    }
  }

  std::vector<size_t> ByPenetration(const SteeredScene& scene,
                                    const std::vector<Proposal>& proposals) const {
    std::vector<std::pair<double, size_t>> depths;
    for (size_t c = 0; c < proposals.size(); ++c) {
      std::vector<scene::SceneObject> objects = scene.After();
      for (const ProposedObject& one : proposals[c]) objects.push_back(one.object);
      depths.emplace_back(TotalPenetration(objects, asset_set_, scene::BodyShape::kParts), c);
    }
    std::sort(depths.begin(), depths.end());
    std::vector<size_t> order;
    for (const auto& [depth, c] : depths) order.push_back(c);
    return order;
  }

  void TryProposal(const SteeredScene& scene, const Proposal& proposal, size_t rank,
                   Trial* trial) const {
    scene::ConstrainedScene placed = scene.Place(proposal, asset_set_, options_, strict_);
    trial->broken[rank] = scene.BrokenCount(placed, proposal, sizes_);
    const bool succeeded = placed.dropped == 0 && placed.stable && trial->broken[rank] == 0;
    trial->placed[rank] = std::move(placed);
    size_t first = trial->success;
    while (succeeded && rank < first && !trial->success.compare_exchange_weak(first, rank)) {
    }
  }

  // Returns the rank of the first success, else of the stable scene with the fewest broken
  // statements, and of these with the fewest objects dropped.
  size_t BestRank(const Trial& trial) const {
    if (trial.success != SIZE_MAX) return trial.success;
    const auto cost = [&](size_t rank) {
      const scene::ConstrainedScene& placed = trial.placed[rank];
      return std::tuple(!placed.stable, trial.broken[rank], placed.dropped);
    };
    size_t best = 0;
    for (size_t rank = 1; rank < trial.placed.size(); ++rank) {
      if (cost(rank) < cost(best)) best = rank;
    }
    return best;
  }

  // Returns objects that found no new pose to their old one, where it is still free.
  void ReturnMissing() {
    std::vector<size_t> open;
    std::vector<std::vector<std::string>> before;
    std::vector<std::vector<Proposal>> proposals;
    for (size_t i = 0; i < scenes_.size(); ++i) {
      if (scenes_[i].Missing() == 0) continue;
      open.push_back(i);
      before.push_back(scenes_[i].MissingNames());
      proposals.push_back({scenes_[i].AtOldPoses()});
    }
    if (open.empty()) return;
    TakeBest(open, proposals);
    for (size_t i = 0; i < open.size(); ++i) {
      SteeredSceneReport& report = reports_[open[i]];
      --report.attempts;
      report.lost = scenes_[open[i]].MissingNames();
      for (const std::string& name : before[i]) {
        const bool lost = std::count(report.lost.begin(), report.lost.end(), name) > 0;
        if (!lost) report.returned.push_back(name);
      }
    }
  }

  void FinishReports();
  void Write(const fs::path& folder);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const SceneSteeringRequest& request_;
  core::Progress* progress_;
  SceneSteeringReport report_;
  SceneSource source_;
  fs::path weights_;
  scene::SceneModel model_;
  SteeringGoal goal_;
  SourceAssets source_assets_;
  scene::ConstrainedOptions options_;
  bool strict_ = false;  // objects of relations that do not hold are proposed again
  std::vector<SteeredScene> scenes_;
  std::vector<SteeredSceneReport> reports_;
  std::set<std::string> wanted_;  // categories of all objects so far
  scene::AssetSet asset_set_;
  scene::CategorySizes sizes_;  // of asset_set_
};

void SceneSteering::FinishReports() {
  for (size_t i = 0; i < scenes_.size(); ++i) {
    const SteeredScene& scene = scenes_[i];
    SteeredSceneReport& report = reports_[i];
    report.name = scene.name();
    report.asked = scene.asked();
    for (const SteeredObject& object : scene.objects()) {
      report.kept += object.kept;
      report.done += !object.kept && object.placed;
    }
    report.done -= static_cast<int>(report.returned.size());
    report.stable = scene.stable() && scene.unstable().empty();
    report.kept_displacement = scene.kept_displacement();
    report.penetration = scene.penetration();
    report.drift = scene.drift();
    report.unstable = scene.unstable();
    report.statements = static_cast<int>(goal_.prompt.relations.size() + goal_.prompt.tiers.size());
    report.broken = scene.Broken(sizes_);
    if (!request_.goal.rearrange) report.missing = scene.MissingNames();
  }
  core::Findings findings = source_assets_.UnknownFindings();
  report_.findings.insert(report_.findings.begin(), findings.begin(), findings.end());
  findings = SteeringFindings(reports_, request_.goal.rearrange);
  report_.findings.insert(report_.findings.end(), findings.begin(), findings.end());
  report_.scenes = std::move(reports_);
}

void SceneSteering::Write(const fs::path& folder) {
  int most = 0;
  for (const SteeredScene& scene : scenes_) {
    most = std::max(most, static_cast<int>(scene.After().size()));
  }
  core::OrderedJson settings;
  settings["weights"] = core::ContentHash(core::ReadFile(weights_));
  settings["steps"] = request_.sampling.steps;
  settings["eta"] = request_.sampling.eta;
  settings["steering"] = request_.goal.rearrange ? "rearrange" : "complete";
  scene::SceneShard part{
      source_assets_.ExtendedVocabulary(most),
      {request_.sampling.seed, 0, "{}", core::JsonLine(settings), SIMWRIGHT_VERSION},
      {},
      {}};
  const auto size = static_cast<size_t>(part.vocabulary.entries * part.vocabulary.TokenWidth());
  std::vector<ScenePair> pairs;
  for (size_t i = 0; i < scenes_.size(); ++i) {
    const std::vector<scene::SceneObject> after = scenes_[i].After();
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene(after, part.vocabulary, &part.tokens[part.tokens.size() - size]);
    const SteeredSceneReport& report = report_.scenes[i];
    const auto count = static_cast<int>(after.size());
    const int missing = report.asked - report.done - static_cast<int>(report.returned.size());
    part.attempts.push_back({count + missing, count, missing, true, true, 0.0, report.penetration,
                             std::max(report.drift, report.kept_displacement)});
    pairs.push_back({scenes_[i].Before(), after});
  }
  scene::WriteShard(part, folder / scene::ShardName(0));
  {
    const core::ScopedTimer timer(&report_.picture_seconds);
    WriteBeforeAfter(pairs, asset_set_, folder);
  }
  report_.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  core::WriteFile(folder / "report.json", SteeringJson(report_));
}

}  // namespace

scene::SampleOptions SceneSteeringRequest::DefaultSampling() {
  scene::SampleOptions sampling;
  sampling.steps = 50;
  return sampling;
}

bool SceneSteeringReport::Succeeded() const {
  return std::all_of(scenes.begin(), scenes.end(), [](const SteeredSceneReport& scene) {
    return scene.stable && scene.lost.empty();
  });
}

SceneSteeringReport SteerScenes(const SceneSteeringRequest& request, core::Progress* progress) {
  ValidateSteering(request);
  return SceneSteering(request, progress).Run();
}

}  // namespace simwright::workflows
