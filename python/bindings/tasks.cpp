#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "llm/make_chat_model.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/reports.h"
#include "rl/training.h"
#include "skills/skill.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/skill_rollout.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_training.h"
#include "workflows/tasks/task_making.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
namespace fs = std::filesystem;

// The model at `url` ("env": SIMWRIGHT_LLM_URL) or of a transcript; null for neither. The key is
// that of SIMWRIGHT_LLM_KEY.
std::unique_ptr<llm::ChatModel> LanguageModel(const std::string& url, const std::string& name,
                                              const fs::path& cache, const fs::path& replay) {
  if (url.empty() && replay.empty()) return nullptr;
  llm::ChatModelOptions options;
  options.replay = replay;
  if (replay.empty()) {
    if (url != "env") options.url = url;
    options.model = name;
    options.cache = cache;
    options = llm::WithEnvironment(options, [](const char* key) { return std::getenv(key); });
    if (options.url.empty()) {
      throw core::Error("is 'env', and SIMWRIGHT_LLM_URL is not set", "llm", "give an address");
    }
  }
  return llm::MakeChatModel(options);
}

nb::object MakeTasks(const std::vector<std::string>& assets, const fs::path& output, int count,
                     std::uint64_t seed, bool force, const std::string& url,
                     const std::string& model_name, const fs::path& cache, const fs::path& replay,
                     const nb::object& report) {
  const std::unique_ptr<llm::ChatModel> model = LanguageModel(url, model_name, cache, replay);
  workflows::TasksRequest request;
  request.assets = assets;
  request.output = output;
  request.count = count;
  request.seed = seed;
  request.force = force;
  request.model = model.get();
  return FromJson(workflows::TasksJson(RunLong(
      report, [&](core::Progress* progress) { return workflows::MakeTasks(request, progress); })));
}

nb::object TrainTask(const fs::path& file, const std::vector<std::string>& tasks,
                     const fs::path& output, const std::string& robot,
                     const std::string& action_space, int environments, std::int64_t samples,
                     double minutes, std::int64_t imitated_samples, int episodes,
                     std::uint64_t seed, bool resume, const nb::object& report) {
  workflows::TrainRequest request;
  request.task_file = file;
  request.tasks = tasks;
  request.output = output;
  request.robot = robot;
  request.action = skills::ActionSpaceOf(action_space);
  request.environments = environments;
  request.samples = samples;
  request.minutes = minutes;
  request.imitated_samples = imitated_samples;
  request.episodes = episodes;
  request.seed = seed;
  request.resume = resume;
  return FromJson(workflows::TrainJson(RunLong(
      report, [&](core::Progress* progress) { return workflows::TrainTask(request, progress); })));
}

nb::object Rollout(const fs::path& run, int episodes, std::uint64_t seed, const fs::path& on,
                   const std::vector<std::string>& tasks, const fs::path& pictures,
                   const nb::object& report) {
  workflows::RolloutRequest request;
  request.run = run;
  request.episodes = episodes;
  request.seed = seed;
  request.on = on;
  request.tasks = tasks;
  request.pictures = pictures;
  return FromJson(workflows::RolloutJson(RunLong(
      report, [&](core::Progress* progress) { return workflows::Rollout(request, progress); })));
}

nb::object ExportRun(const fs::path& run, const fs::path& output, const std::string& format,
                     int episodes, std::uint64_t seed, bool force, const std::string& pace,
                     const nb::object& report) {
  workflows::ExportRequest request;
  if (pace != "limits" && pace != "recorded") {
    throw core::Error("is '" + pace + "'", "pace", "give limits or recorded");
  }
  request.at_recorded_speed = pace == "recorded";
  request.run = run;
  request.output = output;
  request.episodes = episodes;
  request.seed = seed;
  request.force = force;
  if (format == "csv") {
    request.format = workflows::ExportFormat::kCsv;
  } else if (format == "robomimic") {
    request.format = workflows::ExportFormat::kRobomimic;
  } else if (format != "ros2") {
    throw core::Error("is '" + format + "'", "format", "give ros2, csv or robomimic");
  }
  return FromJson(workflows::ExportJson(RunLong(
      report, [&](core::Progress* progress) { return workflows::Export(request, progress); })));
}

nb::dict ReadRun(const fs::path& folder) {
  const workflows::SkillRun run = workflows::ReadRun(folder);
  nb::list subtasks;
  int number = 0;
  for (const tasks::Subtask& subtask : run.set.tasks.front().subtasks) {
    nb::dict entry;
    entry["name"] = subtask.name;
    entry["policy"] =
        (workflows::SkillFolder(run, ++number, subtask.name) / rl::kPolicyFile).string();
    subtasks.append(entry);
  }
  nb::dict dict;
  dict["tasks"] = (folder / "tasks.json").string();
  dict["robot"] = run.robot;
  dict["action_space"] = std::string(skills::NameOf(run.options.action));
  dict["episode_seconds"] = run.options.episode_seconds;
  dict["proved_grasps"] = run.proved_grasps;
  dict["finger_friction"] = nb::none();
  if (run.options.finger_friction) {
    dict["finger_friction"] =
        nb::make_tuple(run.options.finger_friction->low, run.options.finger_friction->high);
  }
  dict["subtasks"] = subtasks;
  return dict;
}

}  // namespace

void BindTasks(nb::module_& module) {
  module.def("make_tasks", &MakeTasks, "assets"_a, "output"_a, "count"_a, "seed"_a, "force"_a,
             "llm"_a, "llm_model"_a, "llm_cache"_a, "replay"_a, "report"_a = nb::none());
  module.def("train_task", &TrainTask, "file"_a, "tasks"_a, "output"_a, "robot"_a, "action_space"_a,
             "environments"_a, "samples"_a, "minutes"_a, "imitated_samples"_a, "episodes"_a,
             "seed"_a, "resume"_a, "report"_a = nb::none());
  module.def("rollout", &Rollout, "run"_a, "episodes"_a, "seed"_a, "on"_a, "tasks"_a, "pictures"_a,
             "report"_a = nb::none());
  module.def(
      "read_run", &ReadRun, "folder"_a,
      "Returns the tasks' file, robot, settings and subtasks, with their policies' paths, of "
      "a folder of a training.");
  module.def("export_run", &ExportRun, "run"_a, "output"_a, "format"_a, "episodes"_a, "seed"_a,
             "force"_a, "pace"_a, "report"_a = nb::none());
}

}  // namespace simwright::python
