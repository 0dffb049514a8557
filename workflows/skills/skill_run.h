#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/finding.h"
#include "skills/skill.h"
#include "tasks/task.h"

namespace simwright::workflows {

// The tasks and settings of a training; its folder stores them as run.json beside tasks.json.
struct SkillRun {
  std::filesystem::path folder;
  // The training tasks: one, or several similar ones (a door on six microwaves) with the same
  // number of subtasks; subtasks at the same position share a policy.
  tasks::TaskSet set;
  std::vector<std::string> hashes;  // content hashes of set.assets at the start of the run
  std::string robot = "panda";      // panda, panda_on_base, or a URDF with its side file
  skills::SkillOptions options;
  // True if rigid objects and sliding parts are grasped by the proved grasps of their grasps.json,
  // where they have one (docs/grasps.md); else from above.
  bool proved_grasps = true;
  bool randomized = true;  // false: options.WithoutRandomization() applies
  int environments = 64;
  std::uint64_t seed = 1;
};

// One subtask of the run.
struct RunSkill {
  std::string name;
  std::filesystem::path folder;
  std::shared_ptr<const skills::Skill> skill;      // for training
  std::shared_ptr<const skills::Skill> evaluated;  // for evaluation, without easier starts
};

// Returns the names of the tasks of `set`, read from `file`, that match one of `patterns` ('*'
// matches any characters, as in a shell). Throws core::Error, listing the known names, if a pattern
// matches none.
std::set<std::string> MatchingTaskNames(const tasks::TaskSet& set,
                                        const std::vector<std::string>& patterns,
                                        const std::string& file);

// Returns the tasks of `set`, read from `file`, whose names match one of `patterns` ('*' matches
// any characters, as in a shell), without duplicates. Throws core::Error, listing the known names,
// if a pattern matches none, or if the tasks have different numbers of subtasks.
tasks::TaskSet ChooseTasks(const tasks::TaskSet& set, const std::vector<std::string>& patterns,
                           const std::string& file);

// Writes run.json and tasks.json into run.folder, or compares them with the existing ones: a run
// resumes only with the settings it started with. Throws core::Error, naming the difference.
void WriteRun(const SkillRun& run);

// Reads a run. Throws core::Error if the folder has no run, or if an asset is missing or has
// changed since, naming it.
SkillRun ReadRun(const std::filesystem::path& folder);

// Returns the folder of the run's subtask of this number (from 1) and name.
std::filesystem::path SkillFolder(const SkillRun& run, int number, const std::string& subtask);

// Returns the robot of this name; it lives as long as the program.
const robot::RobotModel& RobotOf(const std::string& name);

// Reads the assets and prepares each subtask. Appends what was not used to `findings`, if given.
std::vector<RunSkill> PrepareSkills(const SkillRun& run, core::Findings* findings = nullptr);

// Prepares the run's subtasks in the scenes of other similar tasks, to evaluate skills on other
// assets. Throws core::Error if those have a different number of subtasks.
std::vector<RunSkill> PrepareSkillsOn(const tasks::TaskSet& set, const SkillRun& run,
                                      core::Findings* findings = nullptr);

// Returns the number of proved grasps that the skills may use, by asset that is grasped by them.
std::map<std::string, int> GraspCounts(const std::vector<RunSkill>& skills);

}  // namespace simwright::workflows
