#include "workflows/scenes/scene_search.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include "core/content_hash.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/folder_lock.h"
#include "core/json.h"
#include "scene/dataset/scene_dataset.h"
#include "steering/search/search_state.h"
#include "workflows/scenes/finished_scene.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_sheet.h"
#include "workflows/scenes/scene_weights.h"
#include "workflows/scenes/search_pictures.h"
#include "workflows/scenes/start_scene.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr char kStateFile[] = "search.state", kRandomStateFile[] = "random.state";

void ValidateSearch(const SceneSearchRequest& request) {
  std::string error;
  if (!request.search.IsValid(&error)) throw core::Error(error, "the search");
  if (!request.repair.IsValid(&error)) throw core::Error(error, "the repair");
  if (!request.sampling.IsValid(&error)) throw core::Error(error, "sampling");
  if (request.save_every < 1) {
    throw core::Error("the state must be saved every 1 or more iterations", "--save-every");
  }
  if (request.weights.empty() == request.type.empty()) {
    throw core::Error("give either weights or a scene type, not both", "",
                      "name a weights file, or a --type with shipped weights");
  }
}

// Returns the text that identifies a search: what its result depends on, but the number of
// iterations.
std::string SearchSettings(const SceneSearchRequest& request, const fs::path& weights,
                           const std::optional<StartScene>& start) {
  const steering::SearchOptions& search = request.search;
  core::OrderedJson json;
  json["weights"] = core::ContentHash(core::ReadFile(weights));
  json["objective"] = request.objective.objective;
  json["task"] = request.objective.task;
  json["prompt"] = request.objective.prompt;
  json["mask"] = request.objective.mask;
  json["branching"] = search.branching;
  json["exploration"] = search.exploration;
  json["scaled"] = search.scaled;
  json["backs_up_all"] = search.backs_up_all;
  json["leaves"] = search.leaves;
  json["fill"] = search.fill;
  json["confirms"] = search.confirms;
  json["repair"] = request.repair.repair == steering::Repair::kProject ? "project" : "none";
  json["steps"] = request.sampling.steps;
  json["eta"] = request.sampling.eta;
  json["clamping"] =
      request.sampling.clamping == scene::Clamping::kCleanValues ? "clean" : "noised";
  json["seed"] = search.seed;
  if (start.has_value()) {
    const std::vector<float>& tokens = start->scene.tokens;
    json["start"] = core::ContentHash(std::string_view(reinterpret_cast<const char*>(tokens.data()),
                                                       tokens.size() * sizeof(float)));
  }
  return core::JsonLine(json);
}

// A new or continued search in its folder.
class SceneSearchRun {
 public:
  SceneSearchRun(const SceneSearchRequest& request, core::Progress* progress)
      : request_(request),
        progress_(progress),
        weights_(request.weights.empty() ? ShippedSceneWeights(request.type) : request.weights),
        model_(scene::SceneModel::Load(weights_, request.text_encoder)) {
    if (!request.start.empty()) {
      start_scene_ =
          ReadStartScene(request.start, request.start_scene, request.assets, vocabulary());
    }
    settings_ = SearchSettings(request, weights_, start_scene_);
    report_.output = request.output;
    // Reads the objective before anything is written; sizes do not matter for that.
    core::Findings unused;
    MakeSearchGoal(request.objective, vocabulary(), {}, &unused);
    PrepareFolder();
  }

  SceneSearchReport Run() {
    const core::FolderLock lock(request_.output, "a search");
    GatherAssets();
    goal_ = MakeSearchGoal(request_.objective, vocabulary(), asset_set_, &report_.findings);
    steering::SceneSearch search = NewSearch(false, request_.search.iterations);
    report_.interrupted = !Search("search", kStateFile, &search);
    report_.records = search.records();
    if (request_.random && !report_.interrupted) {
      const int iterations = std::max(1, search.IterationCount());
      steering::SceneSearch random = NewSearch(true, iterations);
      report_.interrupted = !Search("random search", kRandomStateFile, &random);
      report_.random_records = random.records();
    }
    Describe(search);
    WriteResult(search);
    progress_->Finish();
    return std::move(report_);
  }

 private:
  const scene::Vocabulary& vocabulary() const { return model_.metadata().vocabulary; }

  void PrepareFolder() const {
    const fs::path& output = request_.output;
    if (request_.resume) {
      if (!fs::exists(output / kStateFile)) {
        throw core::Error("there is no search to resume", output.string(),
                          "start it without --resume");
      }
      steering::ReadSearchState(output / kStateFile, vocabulary(), settings_);
      return;
    }
    if (fs::exists(output) && !request_.force) {
      throw core::Error("the output exists already", output.string(),
                        "choose another, or give --force, or --resume to continue its search");
    }
    if (fs::exists(output)) core::RequireReplaceable(output);
    fs::remove_all(output);
  }

  void GatherAssets() {
    SceneAssetsRequest wanted;
    wanted.categories = vocabulary().categories;
    if (!request_.assets.empty()) wanted.folders.push_back(request_.assets);
    if (start_scene_.has_value()) {
      wanted.chosen = start_scene_->folders;
      if (fs::is_directory(start_scene_->assets)) wanted.folders.push_back(start_scene_->assets);
    }
    wanted.kept = request_.output / "assets";
    wanted.findings = &report_.findings;
    asset_set_ = scene::ReadAssetSet(GatherSceneAssets(wanted, progress_));
  }

  steering::SceneSearch NewSearch(bool random, int iterations) {
    steering::SearchOptions options = request_.search;
    options.random = random;
    options.iterations = iterations;
    options.allowed = goal_.allowed;
    options.most_objects = goal_.most_objects;
    const auto inpaint = [this](const std::vector<float>& tokens, const scene::InpaintingMask& mask,
                                std::uint64_t seed) {
      scene::SampleOptions sampling = request_.sampling;
      sampling.one_by_one = true;
      sampling.seed = seed;
      if (model_.metadata().options.text && !goal_.prompt.empty()) {
        sampling.prompts = {goal_.prompt};
      }
      core::Progress silent;
      return model_.Inpaint(tokens, mask, sampling, &silent);
    };
    steering::SceneSearch search(vocabulary(), asset_set_, *goal_.mask, *goal_.reward, inpaint,
                                 options, request_.repair);
    search.SetFinalCheck([this](const std::vector<scene::SceneObject>& objects) {
      return MovingObjects(objects,
                           CheckInBothEngines(objects, vocabulary(), request_.output / "assets"));
    });
    return search;
  }

  // Runs a search and saves its state on the way; returns false if it was interrupted.
  bool Search(const char* stage, const char* file, steering::SceneSearch* search) {
    const fs::path path = request_.output / file;
    int before = 0;
    const auto count = [&] {
      report_.iterations_run += search->IterationCount() - before;
      report_.model_seconds += search->model_seconds();
      report_.physics_seconds += search->physics_seconds();
    };
    try {
      if (request_.resume && fs::exists(path)) {
        search->Resume(steering::ReadSearchState(path, vocabulary(), settings_));
      } else if (start_scene_.has_value() && file == kStateFile) {
        search->StartWith(start_scene_->scene);
      } else {
        search->Start();
      }
      before = search->IterationCount();
      Iterate(stage, path, search);
    } catch (const core::Cancelled&) {
      if (search->best() < 0) throw;  // nothing to keep yet
      count();
      Save(*search, path);
      return false;
    }
    count();
    Save(*search, path);
    return true;
  }

  void Iterate(const char* stage, const fs::path& path, steering::SceneSearch* search) {
    const int before = search->IterationCount();
    progress_->Stage(stage, std::max(0, SearchBudget(*search) - before));
    Save(*search, path);
    for (int saved = before; !search->Finished();) {
      const int count = search->IterationCount();
      search->Iterate();
      char detail[64];
      std::snprintf(detail, sizeof detail, "best %g of %g", search->best_reward(),
                    goal_.reward->Goal());
      progress_->Say(detail);
      if (search->IterationCount() - saved >= request_.save_every) {
        saved = search->IterationCount();
        Save(*search, path);
      }
      for (int i = count; i < search->IterationCount(); ++i) progress_->Advance();
    }
  }

  int SearchBudget(const steering::SceneSearch& search) const {
    return search.ReachedGoal() ? search.IterationCount() : request_.search.iterations;
  }

  void Save(const steering::SceneSearch& search, const fs::path& path) const {
    steering::WriteSearchState(search.State(), vocabulary(), settings_, path);
  }

  void Describe(const steering::SceneSearch& search) {
    report_.objective = goal_.reward->Name();
    report_.goal = goal_.reward->Goal();
    report_.start_reward = search.tree().nodes().front().reward;
    report_.best_reward = search.best_reward();
    report_.reached_goal = search.ReachedGoal();
    report_.depth = static_cast<int>(search.tree().PathTo(search.best()).size()) - 1;
    for (size_t i = report_.records.size(); i-- > 0;) {
      if (report_.records[i].best >= report_.best_reward) {
        report_.best_iteration = static_cast<int>(i) + 1;
      }
    }
    if (report_.start_reward >= report_.best_reward) report_.best_iteration = 0;
    const auto best = static_cast<size_t>(search.best());
    report_.feasible_in_search = search.scenes()[best].Judged(vocabulary()).FeasibleCount(true);
  }

  void WriteResult(const steering::SceneSearch& search);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const SceneSearchRequest& request_;
  core::Progress* progress_;
  fs::path weights_;
  scene::SceneModel model_;
  std::optional<StartScene> start_scene_;
  std::string settings_;
  SearchGoal goal_;
  scene::AssetSet asset_set_;
  SceneSearchReport report_;
};

// Writes the best scene without what is masked, after full physics, and the reports. An interrupted
// search writes it as it is, and no pictures.
void SceneSearchRun::WriteResult(const steering::SceneSearch& search) {
  const steering::JudgedScene best =
      search.scenes()[static_cast<size_t>(search.best())].Judged(vocabulary());
  FinishedScene finished;
  for (size_t i = 0; i < best.objects.size(); ++i) {
    if (best.IsFeasible(i)) finished.objects.push_back(best.objects[i]);
  }
  const auto sampled = static_cast<int>(best.objects.size());
  if (!report_.interrupted) {
    progress_->Stage("checking");
    finished = FinishScene(finished.objects, vocabulary(), asset_set_, request_.output / "assets");
  }
  const auto count = static_cast<int>(finished.objects.size());
  report_.objects = count;
  report_.stability = finished.stability;
  const std::vector<char> still(finished.objects.size(), 0);
  report_.final_reward = goal_.reward->Evaluate({finished.objects, still, still});
  core::OrderedJson settings = core::ParseOrderedJson(settings_, "the settings");
  settings["steering"] = "search";
  const scene::ShardOrigin origin{request_.search.seed, 0, "{}", core::JsonLine(settings),
                                  SIMWRIGHT_VERSION};
  const fs::path& folder = request_.output;
  WriteSingleScene(finished.objects, vocabulary(), origin,
                   {sampled, count, sampled - count, true, true, 0.0, finished.penetration, 0.0},
                   folder / scene::ShardName(0));
  if (!report_.interrupted) {
    WriteBestPath(search, vocabulary(), asset_set_, folder / "best_path.png");
    WriteSceneSheet(scene::SceneDataset(folder), asset_set_, folder / "scenes.png");
  }
  report_.seconds = core::SecondsSince(start_);
  core::WriteFile(folder / "search.svg", SearchCurves(report_));
  core::WriteFile(folder / "search.json", SearchJson(report_));
}

}  // namespace

scene::SampleOptions SceneSearchRequest::DefaultSampling() {
  scene::SampleOptions sampling;
  sampling.steps = 50;
  return sampling;
}

SceneSearchReport SearchScenes(const SceneSearchRequest& request, core::Progress* progress) {
  ValidateSearch(request);
  return SceneSearchRun(request, progress).Run();
}

}  // namespace simwright::workflows
