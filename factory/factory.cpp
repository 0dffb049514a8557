#include "factory/factory.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/free_memory.h"
#include "core/json.h"
#include "core/log.h"
#include "core/parallel.h"
#include "factory/factory_asset.h"
#include "factory/factory_folder.h"
#include "factory/factory_record.h"
#include "factory/factory_tasks.h"
#include "scene/dataset/shard_claim.h"

namespace simwright::factory {
namespace fs = std::filesystem;
namespace {

constexpr double kPageSeconds = 3.0;  // between two versions of the dashboard
constexpr double kWaitSeconds = 0.5;  // between two looks for what other workers left
constexpr std::chrono::milliseconds kClaimWait{50};

double ProcessSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Waits until the claim on `path` is this worker's.
std::unique_ptr<scene::ShardClaim> WaitForClaim(const fs::path& path) {
  for (;;) {
    auto claim = std::make_unique<scene::ShardClaim>(path);
    if (claim->held()) return claim;
    core::CheckCancelled();
    std::this_thread::sleep_for(kClaimWait);
  }
}

// Returns the plan of the folder: the one that is there, or the request's, which is then written.
FactoryPlan SharedPlan(const FactoryRequest& request, const FactoryFolder& folder,
                       core::Findings* findings) {
  const bool stated = !request.plan.empty() || !request.theme.theme.empty();
  std::optional<FactoryPlan> asked;
  if (stated) {
    asked = request.plan.empty() ? PlanOfTheme(request.theme, findings)
                                 : ReadFactoryPlan(request.plan, findings);
  }
  const bool shared = request.place.workers() > 1;
  std::unique_ptr<scene::ShardClaim> claim;  // beside the folder, which has to be empty
  if (shared) {
    fs::path root = fs::absolute(folder.root).lexically_normal();
    if (root.filename().empty()) root = root.parent_path();
    fs::create_directories(root.parent_path());
    claim = WaitForClaim(root);
  }
  if (fs::exists(folder.plan())) {
    if (!request.resume && !(shared && asked)) {
      throw core::Error("the folder holds a factory", folder.root.string(),
                        "--resume resumes it, or joins its workers");
    }
    const FactoryPlan present = ReadPlanText(folder.plan());
    if (asked && PlanText(*asked) != PlanText(present)) {
      throw core::Error("the folder holds a factory with another plan", folder.root.string(),
                        "leave the plan out to resume it, or choose another folder");
    }
    return present;
  }
  if (!asked) {
    throw core::Error("there is no factory to resume", folder.root.string(),
                      "give a PLAN or --theme");
  }
  if (fs::exists(folder.root) && !fs::is_empty(folder.root)) {
    throw core::Error("the folder exists and is not empty", folder.root.string(),
                      "choose another folder");
  }
  fs::create_directories(folder.root);
  core::WriteFile(folder.plan(), PlanText(*asked));
  return *asked;
}

// One worker: this process with its threads.
class FactoryWorker {
 public:
  FactoryWorker(const FactoryRequest& request, FactoryPlan plan, core::Progress* progress)
      : request_(request), folder_{request.output}, plan_(std::move(plan)), progress_(*progress) {
    fs::create_directories(folder_.records());
    fs::create_directories(folder_.assets());
  }

  void MakeAssets() {
    progress_.Stage("assets", static_cast<int>(plan_.items.size()));
    DoUnits(
        static_cast<int>(plan_.items.size()),
        [&](int i) { return folder_.asset_record(Item(i).name); },
        [&](int i) {
          return AssetRecordText(MakeFactoryAsset(Item(i), folder_, request_.generator));
        });
  }

  void MakeTasks() {
    const int parts = PartCount(plan_);
    if (parts == 0) return;
    progress_.Stage("tasks", parts);
    MakeParts(0, parts, [&](int part) { return AskedTasks(plan_, part); });
    // Parts that fell short are made up for by further ones, with other assets.
    int all = parts;
    for (; all < 2 * parts; ++all) {
      const int missing = plan_.tasks - ReadFactoryState(plan_, folder_).tasks();
      const bool recorded = fs::exists(folder_.task_record(all));
      if (missing <= 0 && !recorded) break;
      if (recorded) continue;
      MakeParts(all, all + 1, [&](int) { return std::min(missing, plan_.tasks_per_part); });
    }
    if (!request_.place.leads()) return;
    const auto claim = WaitForClaim(folder_.tasks());
    JoinTaskParts(all, folder_);
  }

  // Writes the dashboard; `last`: even if the present one is new.
  void WritePage(WorkerStage stage, bool last) {
    if (!request_.place.leads()) return;
    const std::lock_guard lock(page_mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (!last && std::chrono::duration<double>(now - page_written_).count() < page_seconds_) return;
    page_written_ = now;
    core::WriteFile(folder_.page(),
                    FactoryPage(plan_, ReadFactoryState(plan_, folder_), State(stage)));
  }

  WorkerState State(WorkerStage stage) const {
    WorkerState state;
    state.stage = stage;
    state.threads = core::ThreadCount();
    state.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    state.busy = std::min(
        1.0, (ProcessSeconds() - processor_) / std::max(1e-3, state.seconds * state.threads));
    return state;
  }

  FactoryReport Report(core::Findings findings) {
    FactoryReport report;
    report.plan = plan_;
    report.state = ReadFactoryState(plan_, folder_);
    report.worker = State(WorkerStage::kFinished);
    report.folder = folder_.root;
    report.page = folder_.page();
    if (fs::exists(folder_.tasks())) report.tasks = folder_.tasks();
    report.kept = kept_;
    report.findings = std::move(findings);
    for (const AssetRecord& asset : report.state.assets) {
      for (const core::Finding& finding : asset.findings) {
        if (finding.code == "factory-variants-failed") report.findings.push_back(finding);
      }
      if (asset.made()) continue;
      report.findings.push_back(
          {"factory-asset-failed", core::Severity::kWarning, asset.name,
           asset.failures.empty() ? "the asset was not made" : asset.failures.back().reason, 0.0,
           "see the dashboard for all attempts"});
    }
    if (report.state.tasks() < plan_.tasks) {
      report.findings.push_back({"factory-fewer-tasks", core::Severity::kWarning, "",
                                 "the assets give " + std::to_string(report.state.tasks()) +
                                     " verified tasks of " + std::to_string(plan_.tasks),
                                 static_cast<double>(report.state.tasks()), "make more assets"});
    }
    return report;
  }

 private:
  const FactoryItem& Item(int i) const { return plan_.items[static_cast<size_t>(i)]; }

  void MakeParts(int first, int last, const std::function<int(int)>& asked) {
    DoUnits(
        last - first, [&](int k) { return folder_.task_record(first + k); },
        [&](int k) {
          return TaskPartText(MakeTaskPart(plan_, first + k, asked(first + k), folder_));
        });
  }

  // Does all units of work that have no record: those that nobody else has claimed, then those
  // that others leave. `make` returns the text of unit i's record.
  void DoUnits(int count, const std::function<fs::path(int)>& record_of,
               const std::function<std::string(int)>& make) {
    bool first = true;
    for (;;) {
      core::ParallelFor(count, [&](int i) {
        const fs::path record = record_of(i);
        if (fs::exists(record)) {
          Count(record, first);
          return;
        }
        core::CheckCancelled();
        const scene::ShardClaim claim(record);
        if (!claim.held() || fs::exists(record)) return;
        const std::string text = make(i);
        core::WriteFile(record, text);
        core::Log(core::LogLevel::kInfo, "factory", "recorded ", record.stem().string());
        core::ReturnFreeMemory();
        Count(record, false);
        WritePage(WorkerStage::kRunning, false);
      });
      first = false;
      bool all = true;
      for (int i = 0; i < count && all; ++i) all = fs::exists(record_of(i));
      if (all) return;
      core::CheckCancelled();
      WritePage(WorkerStage::kRunning, false);
      std::this_thread::sleep_for(std::chrono::duration<double>(kWaitSeconds));
    }
  }

  // Counts a unit that is recorded, once; `kept`: it was before this worker began.
  void Count(const fs::path& record, bool kept) {
    {
      const std::lock_guard lock(page_mutex_);
      if (!counted_.insert(record.filename().string()).second) return;
      if (kept && record.filename().string().rfind("tasks_", 0) != 0) ++kept_;
    }
    progress_.Advance();
  }

  const FactoryRequest& request_;
  FactoryFolder folder_;
  FactoryPlan plan_;
  core::Progress& progress_;
  std::mutex page_mutex_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(),
                                        page_written_ = start_;
  // Each task of an array writes it.
  double page_seconds_ = kPageSeconds * std::min(20, request_.place.array_tasks);
  double processor_ = ProcessSeconds();
  int kept_ = 0;
  std::set<std::string> counted_;
};

}  // namespace

FactoryReport RunFactory(const FactoryRequest& request, core::Progress* progress) {
  core::Findings findings;
  FactoryPlan plan = SharedPlan(request, {request.output}, &findings);
  FactoryWorker worker(request, std::move(plan), progress);
  worker.WritePage(WorkerStage::kRunning, true);
  try {
    worker.MakeAssets();
    worker.MakeTasks();
  } catch (...) {
    worker.WritePage(WorkerStage::kStopped, true);
    throw;
  }
  progress->Finish();
  worker.WritePage(WorkerStage::kFinished, true);
  return worker.Report(std::move(findings));
}

std::string FactoryTable(const FactoryReport& report) {
  char text[400];
  std::snprintf(text, sizeof text,
                "assets  %d of %zu made, %d failed, %d texture variants (%d kept)\n"
                "tasks   %d of %d verified\n"
                "time    %.0f s on %d threads, %.0f %% busy\n",
                report.state.made(), report.plan.items.size(), report.state.failed(),
                report.state.variants(), report.kept, report.state.tasks(), report.plan.tasks,
                report.worker.seconds, report.worker.threads, 100.0 * report.worker.busy);
  return text;
}

std::string FactoryJson(const FactoryReport& report) {
  core::OrderedJson json;
  json["folder"] = report.folder.string();
  json["page"] = report.page.string();
  json["tasks_file"] = report.tasks.string();
  json["planned"] = report.plan.items.size();
  json["made"] = report.state.made();
  json["failed"] = report.state.failed();
  json["variants"] = report.state.variants();
  json["kept"] = report.kept;
  json["tasks"] = report.state.tasks();
  json["seconds"] = report.worker.seconds;
  json["busy"] = report.worker.busy;
  return core::JsonText(json);
}

}  // namespace simwright::factory
