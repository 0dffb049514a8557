#include "viewer/contents/run_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "rl/training_log.h"
#include "tasks/task_file.h"
#include "viewer/contents/asset_view.h"
#include "viewer/contents/rollout_view.h"
#include "viewer/contents/task_view.h"
#include "viewer/model_document.h"
#include "workflows/photo_run/photo_run_folder.h"

namespace simwright::viewer {
namespace fs = std::filesystem;
namespace {

using core::OrderedJson;

constexpr int kTries = 30;  // episodes until one of the task succeeds
constexpr std::uint64_t kSeed = 1;
constexpr const char* kTable = "training.csv";

OrderedJson RunFacts(const fs::path& file) {
  const core::JsonDocument document = core::JsonDocument::Read(file, 1 << 24);
  return document.json();
}

Chart ChartOf(const std::string& title, const std::string& y,
              const std::vector<rl::TrainingRecord>& records, double rl::TrainingRecord::*value,
              bool with_interval) {
  Chart chart{title, "samples", y, {}};
  Curve& curve = chart.curves.emplace_back();
  curve.name = y;
  for (const rl::TrainingRecord& record : records) {
    curve.x.push_back(record.samples);
    curve.y.push_back(record.*value);
    if (!with_interval) continue;
    curve.low.push_back(record.success_low);
    curve.high.push_back(record.success_high);
  }
  return chart;
}

// Returns the learning curves of the subtasks below a training's folder. Subtasks without a log
// yet, and logs that cannot be read, have none.
OrderedJson TrainingCharts(const fs::path& folder) {
  std::vector<fs::path> logs;
  std::error_code error;
  for (fs::directory_iterator entries(folder, error), end; !error && entries != end;
       entries.increment(error)) {
    if (fs::exists(entries->path() / kTable)) logs.push_back(entries->path());
  }
  std::sort(logs.begin(), logs.end());
  OrderedJson charts = OrderedJson::array();
  for (const fs::path& log : logs) {
    const std::string name = log.filename().string();
    try {
      const std::vector<rl::TrainingRecord> records =
          rl::ReadTrainingTable(log / kTable, std::numeric_limits<std::int64_t>::max());
      if (records.empty()) continue;
      charts.push_back(ChartJson(ChartOf(name + ": success rate", "success", records,
                                         &rl::TrainingRecord::success, true)));
      charts.push_back(ChartJson(ChartOf(name + ": mean return", "return", records,
                                         &rl::TrainingRecord::mean_return, false)));
    } catch (const core::Error&) {
      continue;
    }
  }
  return charts;
}

// A training, whose policies act when an episode is asked for.
class TrainingContent : public Content {
 public:
  // `variants`: the task, by world, whose episode a replay shows; -1: none.
  TrainingContent(Document document, fs::path folder, std::vector<int> variants)
      : Content(std::move(document)), folder_(std::move(folder)), variants_(std::move(variants)) {}

  OrderedJson Charts() override { return TrainingCharts(folder_); }

  Timeline Replay(int world) override {
    const int variant = variants_[static_cast<std::size_t>(world)];
    if (variant < 0) return Content::Replay(world);
    const std::lock_guard lock(mutex_);
    if (!task_) task_ = std::make_unique<workflows::TrainedTask>(folder_);
    workflows::ChainRecording shown;
    for (int episode = 0; episode < kTries; ++episode) {
      workflows::ChainRecording recording =
          workflows::RecordEpisode(task_->links(), kSeed, static_cast<std::uint64_t>(episode));
      if (recording.subtasks.empty()) continue;
      if (recording.subtasks.front().start.variant != variant) continue;
      shown = std::move(recording);
      if (shown.success) break;
    }
    if (shown.subtasks.empty()) throw core::Error("no episode began in this task");
    return EpisodeTimeline(*task_, shown);
  }

 private:
  fs::path folder_;
  std::vector<int> variants_;
  std::mutex mutex_;
  std::unique_ptr<workflows::TrainedTask> task_;
};

OrderedJson EpisodeOffer() {
  return {{"title", "Record an episode"}, {"waiting", "The policy acts in simulation"}};
}

bool HasPolicies(const workflows::SkillRun& run) {
  int number = 0;
  for (const tasks::Subtask& subtask : run.set.tasks.front().subtasks) {
    if (!fs::exists(workflows::SkillFolder(run, ++number, subtask.name) / "policy.pt"))
      return false;
  }
  return true;
}

// Adds the starts of the run's tasks; returns the variant of each, -1 where none can be recorded.
// `group`: shown before their names; empty: that of the task.
std::vector<int> AddRunWorlds(const workflows::SkillRun& run, const std::string& group,
                              TaskModels* models, DocumentBuilder* builder) {
  std::vector<int> variants;
  const bool recordable = HasPolicies(run);
  for (std::size_t i = 0; i < run.set.tasks.size(); ++i) {
    const tasks::Task& task = run.set.tasks[i];
    for (std::size_t k = 0; k < task.subtasks.size(); ++k) {
      OrderedJson world = SubtaskWorld(task, task.subtasks[k], models);
      if (!group.empty()) world["group"] = group;
      const bool first = k == 0 && recordable;
      if (first) world["replay"] = EpisodeOffer();
      variants.push_back(first ? static_cast<int>(i) : -1);
      builder->AddWorld(std::move(world));
    }
  }
  return variants;
}

// Adds the worlds of a photo run as far as its stages have come; returns the variants.
std::vector<int> AddPhotoRunWorlds(const workflows::PhotoRunFolder& folder,
                                   const tasks::TaskSet& set, TaskModels* models,
                                   DocumentBuilder* builder) {
  std::vector<int> variants;
  if (fs::exists(folder.Poses())) {
    builder->AddWorld(RolloutWorld(ReadRolloutPoses(folder.Poses()), set, models, builder));
    variants.push_back(-1);
  }
  if (IsTrainingFolder(folder.Skill())) {
    const workflows::SkillRun run = workflows::ReadRun(folder.Skill());
    const std::vector<int> more = AddRunWorlds(run, "trained", models, builder);
    variants.insert(variants.end(), more.begin(), more.end());
  }
  for (const tasks::Task& task : set.tasks) {
    for (const tasks::Subtask& subtask : task.subtasks) {
      builder->AddWorld(SubtaskWorld(task, subtask, models));
      variants.push_back(-1);
    }
  }
  return variants;
}

// Adds the rollouts whose poses lie in a training's folder, each as an entry.
void AddRollouts(const workflows::SkillRun& run, TaskModels* models, DocumentBuilder* builder,
                 std::vector<int>* variants) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(run.folder)) {
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    try {
      OrderedJson world = RolloutWorld(ReadRolloutPoses(file), run.set, models, builder);
      world["group"] = file.filename().string();
      builder->AddWorld(std::move(world));
      variants->push_back(-1);
    } catch (const core::Error& error) {
      AddFinding({"view-rollout-not-shown", core::Severity::kWarning, "", error.what()}, builder);
    }
  }
}

std::string FolderName(const fs::path& folder) {
  const fs::path name = fs::absolute(folder).lexically_normal();
  return name.has_filename() ? name.filename().string() : name.parent_path().filename().string();
}

}  // namespace

bool IsTrainingFolder(const fs::path& folder) {
  return fs::exists(folder / "run.json") && fs::exists(folder / "tasks.json") &&
         RunFacts(folder / "run.json").contains("asset_hashes");
}

bool IsPhotoRunFolder(const fs::path& folder) {
  return fs::exists(folder / "run.json") && RunFacts(folder / "run.json").contains("stages");
}

std::unique_ptr<Content> ReadTrainingView(const fs::path& folder) {
  const workflows::SkillRun run = workflows::ReadRun(folder);
  DocumentBuilder builder("run", "training " + FolderName(folder));
  TaskModels models(run.set, workflows::RobotOf(run.robot), &builder);
  std::vector<int> variants = AddRunWorlds(run, "", &models, &builder);
  AddRollouts(run, &models, &builder, &variants);
  builder.manifest()["live"] = true;
  return std::make_unique<TrainingContent>(builder.Take(), folder, std::move(variants));
}

std::unique_ptr<Content> ReadPhotoRunView(const fs::path& root) {
  workflows::PhotoRunFolder folder{root, ""};
  const OrderedJson facts = RunFacts(root / "run.json");
  DocumentBuilder builder("run", "run " + FolderName(root));
  builder.manifest()["live"] = true;
  std::vector<int> variants;
  for (const auto& entry : fs::directory_iterator(root)) {
    if (!entry.is_directory() || !assets::IsAssetFolder(entry.path())) continue;
    OrderedJson model = ModelOfPath(entry.path(), &builder);
    const std::string name = model["name"].get<std::string>();
    OrderedJson world = {{"name", "asset " + name}};
    world["bodies"] = BodiesJson({{name, builder.AddModel(std::move(model))}});
    builder.AddWorld(std::move(world));
    variants.push_back(-1);
  }
  tasks::TaskSet set;
  if (fs::exists(folder.Tasks())) {
    set = tasks::ReadTaskFile(folder.Tasks());
    TaskModels models(set, workflows::RobotOf("panda"), &builder);
    const std::vector<int> more = AddPhotoRunWorlds(folder, set, &models, &builder);
    variants.insert(variants.end(), more.begin(), more.end());
  }
  if (variants.empty()) {
    throw core::Error("the run has nothing to show yet", root.string(),
                      "view it again when its first stage is done");
  }
  return std::make_unique<TrainingContent>(builder.Take(), folder.Skill(), std::move(variants));
}

}  // namespace simwright::viewer
