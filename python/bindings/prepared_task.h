#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <nanobind/nanobind.h>

#include "skills/skill.h"
#include "workflows/skills/skill_run.h"

namespace simwright::python {

// The settings of PreparedTask that Python may change; the others are SkillOptions' defaults.
struct TaskSettings {
  std::string robot = "panda";
  std::string action_space = "focus";
  std::optional<double> episode_seconds;
  std::optional<double> reach, turn, delta_share;  // skills::SkillOptions
  std::optional<std::pair<double, double>> finger_friction;
  bool proved_grasps = true;  // workflows::SkillRun::proved_grasps
};

using JointRange = std::tuple<std::string, double, double>;  // name, lower, upper (rad or m)

// Tasks of a tasks.json, one or several similar ones, with their subtasks ready to run. Constant.
class PreparedTask {
 public:
  // Throws core::Error where ReadTaskFile, ChooseTasks and MakeSkill do.
  PreparedTask(const std::filesystem::path& file, const std::vector<std::string>& tasks,
               const TaskSettings& settings);

  std::vector<std::string> SubtaskNames() const;
  std::vector<std::string> TaskNames() const;
  std::vector<JointRange> ArmJoints() const;
  // Returns the sentence that describes a subtask of the first task.
  std::string Description(int subtask) const;
  // `evaluated`: without easier start states. Throws core::Error for another index.
  std::shared_ptr<const skills::Skill> SkillAt(int subtask, bool evaluated) const;
  const workflows::SkillRun& run() const { return run_; }

 private:
  workflows::SkillRun run_;
  std::vector<workflows::RunSkill> skills_;
};

void BindPreparedTask(nanobind::module_& module);

}  // namespace simwright::python
