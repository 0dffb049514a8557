#include "workflows/skills/skill_run.h"

#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "assets/semantic_model.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "robot/panda_model.h"
#include "tasks/task_file.h"
#include "workflows/grasps/asset_grasps.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kSkillRunFormat = 2;
constexpr const char* kRunFile = "run.json";
constexpr const char* kTasksFile = "tasks.json";

std::string SomeNames(const tasks::TaskSet& set) {
  std::string names;
  for (size_t i = 0; i < set.tasks.size() && i < 8; ++i) {
    names += (i > 0 ? ", " : "") + set.tasks[i].name;
  }
  return set.tasks.size() > 8 ? names + " ..." : names;
}

core::Json RunJson(const SkillRun& run) {
  core::Json text;
  text["format"] = kSkillRunFormat;
  text["robot"] = run.robot;
  text["environments"] = run.environments;
  text["seed"] = run.seed;
  for (const std::string& hash : run.hashes) text["asset_hashes"].push_back(hash);
  text["episode_seconds"] = run.options.episode_seconds;
  text["discount"] = run.options.discount;
  text["action"] = skills::NameOf(run.options.action);
  if (run.proved_grasps) text["proved_grasps"] = true;
  if (run.options.finger_friction) {
    text["finger_friction"] = {run.options.finger_friction->low, run.options.finger_friction->high};
  }
  for (const auto& [asset, range] : run.options.placement_ranges) {
    text["placement_ranges"][asset] = {range.position, range.yaw};
  }
  if (!run.randomized) text["randomized"] = false;
  return text;
}

// Runs from before friction was sampled used the robot's own.
std::optional<skills::FactorRange> FingerFrictionOf(const core::JsonField& text) {
  if (!text.Has("finger_friction")) return std::nullopt;
  const std::vector<double> range = text["finger_friction"].Numbers(2);
  return skills::FactorRange{range[0], range[1]};
}

std::map<std::string, skills::PlacementRange> PlacementRangesOf(const core::JsonField& text) {
  std::map<std::string, skills::PlacementRange> ranges;
  if (!text.Has("placement_ranges")) return ranges;
  for (const auto& [asset, field] : text["placement_ranges"].Members()) {
    const std::vector<double> range = field.Numbers(2);
    ranges[asset] = {range[0], range[1]};
  }
  return ranges;
}

// An asset of a task with its proved grasps.
struct TaskObject {
  assets::SemanticModel model;
  std::vector<manipulation::Grasp> grasps;
};

// Returns the assets by name, with their grasps for `robot`; null: without grasps.
std::map<std::string, TaskObject> ReadTaskObjects(const tasks::TaskSet& set,
                                                  const robot::RobotModel* robot,
                                                  core::Findings* findings) {
  core::Findings unread;
  std::map<std::string, TaskObject> objects;
  for (const tasks::TaskAsset& asset : set.assets) {
    TaskObject object{assets::ReadSemanticModel(asset.path), {}};
    object.model.name = asset.name;
    if (robot != nullptr) {
      object.grasps = GraspsForRobot(asset.path, *robot, findings != nullptr ? findings : &unread);
    }
    objects.emplace(asset.name, std::move(object));
  }
  return objects;
}

// Returns true for the files that `simwright grasps` adds to an asset.
bool IsGraspFile(const fs::path& file) {
  return file.stem().string().starts_with("grasps");
}

// Returns the content hashes of the run's assets. Grasps count only if the run uses them: proving
// some later leaves other runs usable.
std::vector<std::string> HashesOf(const SkillRun& run) {
  std::vector<std::string> hashes;
  for (const tasks::TaskAsset& asset : run.set.assets) {
    if (!fs::exists(asset.path)) {
      throw core::Error("the asset '" + asset.name + "' no longer exists", asset.path,
                        "restore it, or train again");
    }
    std::string hash = core::ContentHashOf(asset.path, IsGraspFile);
    const fs::path grasps = fs::path(asset.path) / manipulation::kGraspFileName;
    if (run.proved_grasps && fs::is_regular_file(grasps)) {
      hash = core::ContentHash(hash + core::ContentHashOf(grasps));
    }
    hashes.push_back(hash);
  }
  return hashes;
}

}  // namespace

std::set<std::string> MatchingTaskNames(const tasks::TaskSet& set,
                                        const std::vector<std::string>& patterns,
                                        const std::string& file) {
  std::set<std::string> names;
  for (const std::string& pattern : patterns) {
    bool any = false;
    for (const tasks::Task& task : set.tasks) {
      if (fnmatch(pattern.c_str(), task.name.c_str(), 0) != 0) continue;
      any = true;
      names.insert(task.name);
    }
    if (!any) {
      throw core::Error("there is no task '" + pattern + "'", file, "it has " + SomeNames(set));
    }
  }
  return names;
}

tasks::TaskSet ChooseTasks(const tasks::TaskSet& set, const std::vector<std::string>& patterns,
                           const std::string& file) {
  MatchingTaskNames(set, patterns, file);  // refuses a pattern without a task
  tasks::TaskSet chosen;
  std::set<std::string> names, used;
  for (const std::string& pattern : patterns) {
    for (const tasks::Task& task : set.tasks) {
      if (fnmatch(pattern.c_str(), task.name.c_str(), 0) != 0) continue;
      if (!names.insert(task.name).second) continue;
      chosen.tasks.push_back(task);
      used.insert(task.assets.begin(), task.assets.end());
    }
  }
  for (const tasks::TaskAsset& asset : set.assets) {
    if (used.contains(asset.name)) chosen.assets.push_back(asset);
  }
  for (const tasks::Task& task : chosen.tasks) {
    if (task.subtasks.size() == chosen.tasks.front().subtasks.size()) continue;
    throw core::Error("'" + task.name + "' differs in its number of subtasks from '" +
                          chosen.tasks.front().name + "'",
                      file, "train them one by one");
  }
  return chosen;
}

void WriteRun(const SkillRun& given) {
  SkillRun run = given;
  run.hashes = HashesOf(run);
  const fs::path file = run.folder / kRunFile;
  const std::string text = core::JsonText(RunJson(run));
  if (fs::exists(file)) {
    if (core::ReadFile(file) != text) {
      throw core::Error("the folder has a run with other tasks, assets or options",
                        run.folder.string(),
                        "give another folder, or the options of the first call (an asset that got "
                        "a grasps.json since then: --grasps above)");
    }
    return;
  }
  fs::create_directories(run.folder);
  tasks::WriteTaskFile(run.set, run.folder / kTasksFile);
  core::WriteFile(file, text);
}

SkillRun ReadRun(const fs::path& folder) {
  const fs::path file = folder / kRunFile;
  if (!fs::exists(file)) {
    throw core::Error("is not a training folder", folder.string(), "see `simwright train`");
  }
  SkillRun run;
  run.folder = folder;
  const core::JsonDocument document = core::JsonDocument::Read(file, 1 << 24, "train again");
  const core::JsonField text = document.root();
  if (text["format"].Int() != kSkillRunFormat) {
    throw core::Error("was written by another version", file.string(), "train again");
  }
  run.robot = text["robot"].Text();
  run.environments = text["environments"].Int();
  run.seed = text["seed"].Unsigned();
  run.hashes = text["asset_hashes"].Texts();
  run.options.episode_seconds = text["episode_seconds"].Number();
  run.options.discount = text["discount"].Number();
  run.options.action = skills::ActionSpaceOf(text["action"].Text());
  // Runs from before grasps were proved took objects from above.
  run.proved_grasps = text.Has("proved_grasps") && text["proved_grasps"].Flag();
  run.options.finger_friction = FingerFrictionOf(text);
  run.options.placement_ranges = PlacementRangesOf(text);
  run.randomized = text.FlagOr("randomized", true);
  run.set = tasks::ReadTaskFile(folder / kTasksFile);
  const std::vector<std::string> now = HashesOf(run);
  for (size_t i = 0; i < now.size(); ++i) {
    if (i < run.hashes.size() && now[i] == run.hashes[i]) continue;
    throw core::Error("the asset '" + run.set.assets[i].name + "' has changed since the training",
                      run.set.assets[i].path, "restore the old one, or train again");
  }
  return run;
}

const robot::RobotModel& RobotOf(const std::string& name) {
  if (name == "panda") return robot::Panda(false);
  if (name == "panda_on_base") return robot::Panda(true);
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<robot::RobotModel>> known;
  const std::lock_guard lock(mutex);
  std::unique_ptr<robot::RobotModel>& model = known[name];
  if (!model) model = std::make_unique<robot::RobotModel>(robot::ReadRobot(name));
  return *model;
}

fs::path SkillFolder(const SkillRun& run, int number, const std::string& subtask) {
  return run.folder / (std::to_string(number) + "_" + subtask);
}

std::map<std::string, int> GraspCounts(const std::vector<RunSkill>& skills) {
  std::map<std::string, int> counts;
  for (const RunSkill& skill : skills) {
    for (const skills::SkillVariant& variant : skill.skill->variants) {
      if (!variant.target || variant.target->grasps.empty()) continue;
      const auto object = static_cast<size_t>(variant.target->object);
      counts[variant.model.objects[object].name] = static_cast<int>(variant.target->grasps.size());
    }
  }
  return counts;
}

std::vector<RunSkill> PrepareSkills(const SkillRun& run, core::Findings* findings) {
  return PrepareSkillsOn(run.set, run, findings);
}

std::vector<RunSkill> PrepareSkillsOn(const tasks::TaskSet& set, const SkillRun& run,
                                      core::Findings* findings) {
  const std::vector<tasks::Subtask>& named = run.set.tasks.front().subtasks;
  if (set.tasks.front().subtasks.size() != named.size()) {
    throw core::Error("differs in its number of subtasks from '" + run.set.tasks.front().name + "'",
                      set.tasks.front().name, "choose a task with the same steps");
  }
  const robot::RobotModel& robot = RobotOf(run.robot);
  const skills::SkillOptions options =
      run.randomized ? run.options : run.options.WithoutRandomization();
  const std::map<std::string, TaskObject> objects =
      ReadTaskObjects(set, run.proved_grasps ? &robot : nullptr, findings);
  std::vector<RunSkill> skills(named.size());
  std::vector<std::shared_ptr<const skills::Skill>> later;  // of the first one, which is made last
  for (size_t k = named.size(); k-- > 0;) {
    std::vector<skills::SkillSubtask> subtasks;
    for (const tasks::Task& task : set.tasks) {
      skills::SkillSubtask& one = subtasks.emplace_back();
      one.subtask = task.subtasks[k];
      if (k + 1 < task.subtasks.size()) one.next = task.subtasks[k + 1];
      for (const std::string& name : task.assets) {
        const TaskObject& object = objects.at(name);
        one.assets.push_back(object.model);
        if (!object.grasps.empty()) one.grasps[name] = object.grasps;
      }
    }
    RunSkill& skill = skills[k];
    skill.name = named[k].name;
    skill.folder = SkillFolder(run, static_cast<int>(k) + 1, skill.name);
    const auto followers = k == 0 ? later : std::vector<std::shared_ptr<const skills::Skill>>();
    skill.skill = skills::MakeSkill(robot, subtasks, options, followers);
    skill.evaluated = skills::MakeSkill(robot, subtasks, options.ForEvaluation(), followers);
    later.insert(later.begin(), skill.evaluated);
  }
  return skills;
}

}  // namespace simwright::workflows
