#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rl/skill.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// What skills are trained for; a training's folder keeps it as run.json beside tasks.json.
struct SkillRun {
  std::filesystem::path folder;
  // The tasks that are practised: one, or several alike (a door on six microwaves) with as many
  // subtasks each, of which those at the same place share a policy.
  tasks::TaskSet set;
  std::vector<std::string> hashes;  // of set.assets, as they were when the run was begun
  std::string robot = "panda";      // panda, panda_on_base, or a URDF with its side file
  rl::SkillOptions options;
  int environments = 64;
  std::uint64_t seed = 1;
};

// One subtask's place in the run.
struct RunSkill {
  std::string name;
  std::filesystem::path folder;
  std::shared_ptr<const rl::Skill> skill;      // as it is trained
  std::shared_ptr<const rl::Skill> evaluated;  // without easier starts
};

// The tasks of `set`, read from `file`, whose names match one of `patterns` ('*' stands for any
// letters, as in a shell), each once. Throws
// core::Error, naming those that are there, where a pattern matches none, or where the tasks have
// different numbers of subtasks.
tasks::TaskSet ChooseTasks(const tasks::TaskSet& set, const std::vector<std::string>& patterns,
                           const std::string& file);

// Writes run.json and tasks.json into run.folder, or compares with what is there: a run goes on
// only as it was begun. Throws core::Error, naming what differs.
void WriteRun(const SkillRun& run);

// Throws core::Error where the folder holds no run, or an asset is gone or has changed since,
// naming it.
SkillRun ReadRun(const std::filesystem::path& folder);

// The robot of the run's name; lives as long as the program.
const robot::RobotModel& RobotOf(const std::string& name);

// Reads the assets and prepares each subtask.
std::vector<RunSkill> PrepareSkills(const SkillRun& run);

// The run's subtasks in the scenes of other tasks alike: what was learnt on some assets, on others.
// Throws core::Error where those have another number of subtasks.
std::vector<RunSkill> PrepareSkillsOn(const tasks::TaskSet& set, const SkillRun& run);

}  // namespace simwright::pipeline
