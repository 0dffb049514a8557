#include "workflows/skills/skill_matching.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/error.h"
#include "core/finding_text.h"
#include "skills/skill_evaluation.h"

namespace simwright::workflows {
namespace {

constexpr size_t kMostNamedSubtasks = 12;  // in an error message

// Returns the asset's name as it appears in names of tasks.
std::string InTaskName(std::string asset) {
  for (char& letter : asset) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '_';
  }
  return asset;
}

// Returns true if `name` is `stem`, or `stem` and a number: "drawer" or "drawer_3".
bool IsNumbered(const std::string& name, const std::string& stem) {
  if (name == stem) return true;
  if (!name.starts_with(stem + "_") || name.size() == stem.size() + 1) return false;
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(stem.size()) + 1, name.end(),
                     [](unsigned char letter) { return std::isdigit(letter) != 0; });
}

// Returns the asset of the task that the skill acts on by the subtask's name; null: none.
const std::string* AssetOf(const SuiteCell& cell, const tasks::Task& task,
                           const tasks::Subtask& subtask) {
  for (const std::string& asset : task.assets) {
    const std::string stem = cell.verb + "_" + InTaskName(asset);
    if (cell.part.empty() ? subtask.name == stem
                          : IsNumbered(subtask.name, stem + "_" + cell.part)) {
      return &asset;
    }
  }
  return nullptr;
}

// Selects subtasks of one file for one policy.
class Matcher {
 public:
  Matcher(const SuiteCell& cell, const rl::Policy& policy, const tasks::TaskSet& set, bool named)
      : cell_(cell), policy_(policy), set_(set), named_(named) {
    for (const tasks::TaskAsset& asset : set.assets) categories_[asset.name] = asset.category;
    run_.robot = cell.robot;
    run_.options.action = ActionSpaceOf(policy);
  }

  // `verbatim`: the user gave this task's full name.
  void Add(const tasks::Task& task, bool verbatim) {
    std::string reason = "no step is to " + cell_.description;
    bool any = false;
    for (const tasks::Subtask& subtask : task.subtasks) {
      const std::string* asset = AssetOf(cell_, task, subtask);
      if (asset == nullptr && !(verbatim && task.subtasks.size() == 1)) continue;
      if (asset != nullptr && !named_ && categories_[*asset] != cell_.category) {
        reason = "'" + *asset + "' is of the category '" + categories_[*asset] + "', not '" +
                 cell_.category + "' (name the task with --task to try it)";
        continue;
      }
      if (const std::string fault = Take(task, subtask); !fault.empty()) {
        reason = fault;
      } else {
        any = true;
      }
    }
    if (!any) match_.skipped.push_back({task.name, reason});
  }

  SkillMatch Finish() {
    match_.set.assets = AssetsOf(match_.set.tasks);
    return std::move(match_);
  }

 private:
  std::vector<tasks::TaskAsset> AssetsOf(const std::vector<tasks::Task>& chosen) const {
    std::set<std::string> used;
    for (const tasks::Task& task : chosen) used.insert(task.assets.begin(), task.assets.end());
    std::vector<tasks::TaskAsset> assets;
    for (const tasks::TaskAsset& asset : set_.assets) {
      if (used.contains(asset.name)) assets.push_back(asset);
    }
    return assets;
  }

  // Takes the subtask, or returns the reason why the policy cannot act in it.
  std::string Take(const tasks::Task& task, const tasks::Subtask& subtask) {
    if (!subtask.valid()) return "its verification found an error";
    const std::string key = subtask.name + "\n" + subtask.program + "\n" + StartKey(subtask.start);
    if (const auto known = known_.find(key); known != known_.end()) {
      return known->second.empty() ? "its step is that of another task" : known->second;
    }
    tasks::Task one = task;
    one.subtasks = {subtask};
    std::string& fault = known_[key];
    fault = FaultOf(one);
    if (!fault.empty()) return fault;
    match_.set.tasks.push_back(std::move(one));
    match_.taken.push_back({task.name, subtask.name});
    return "";
  }

  // Returns a key that equal starts share.
  static std::string StartKey(const tasks::InitialState& start) {
    std::string key = start.held;
    for (const tasks::AssetPlacement& placement : start.placements) {
      key += "\n" + placement.asset;
      for (const double value : placement.world_from_asset.translation()) {
        key += " " + std::to_string(value);
      }
    }
    for (const tasks::JointCondition& joint : start.joints) {
      key += "\n" + joint.asset + " " + joint.joint + " " + std::to_string(joint.position);
    }
    return key;
  }

  std::string FaultOf(const tasks::Task& one) {
    run_.proved_grasps = false;
    run_.set.tasks = {one};
    if (!match_.set.tasks.empty()) run_.set.tasks.push_back(match_.set.tasks.front());
    run_.set.assets = AssetsOf(run_.set.tasks);
    try {
      const auto skills = PrepareSkills(run_);  // refuses a task that reads other inputs
      skills::RequireFits(policy_, *skills.front().evaluated);
    } catch (const core::Error& error) {
      return core::FindingOf(error).sentence;
    }
    return "";
  }

  const SuiteCell& cell_;
  const rl::Policy& policy_;
  const tasks::TaskSet& set_;
  const bool named_;
  SkillRun run_;
  std::map<std::string, std::string> categories_;
  std::map<std::string, std::string> known_;  // reasons by subtask; empty: taken
  SkillMatch match_;
};

std::string SubtasksOf(const tasks::TaskSet& set) {
  std::set<std::string> names;
  for (const tasks::Task& task : set.tasks) {
    for (const tasks::Subtask& subtask : task.subtasks) names.insert(subtask.name);
  }
  std::string text;
  size_t count = 0;
  for (const std::string& name : names) {
    if (count++ == kMostNamedSubtasks) return text + " ...";
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

}  // namespace

bool NamesSkill(const SuiteCell& cell, const tasks::Task& task, const tasks::Subtask& subtask) {
  return AssetOf(cell, task, subtask) != nullptr;
}

SkillMatch MatchSkill(const SuiteCell& cell, const rl::Policy& policy, const tasks::TaskSet& set,
                      const std::vector<std::string>& patterns, const std::string& file) {
  if (set.tasks.empty()) throw core::Error("has no task", file);
  Matcher matcher(cell, policy, set, !patterns.empty());
  const std::set<std::string> names = MatchingTaskNames(set, patterns, file);
  for (const tasks::Task& task : set.tasks) {
    if (!patterns.empty() && !names.contains(task.name)) continue;
    matcher.Add(task, std::find(patterns.begin(), patterns.end(), task.name) != patterns.end());
  }
  SkillMatch match = matcher.Finish();
  if (!match.taken.empty()) return match;
  if (match.skipped.size() == 1) {
    throw core::Error("no step fits the skill '" + cell.name + "': " + match.skipped[0].reason,
                      file + ": " + match.skipped[0].task);
  }
  std::string reason;
  for (const SkippedTask& skipped : match.skipped) {
    if (!skipped.reason.starts_with("no step is to")) reason = skipped.task + ": " + skipped.reason;
  }
  throw core::Error("no step fits the skill '" + cell.name + "' (" + cell.description + ")" +
                        (reason.empty() ? "" : "; " + reason),
                    file, "it has " + SubtasksOf(set));
}

}  // namespace simwright::workflows
