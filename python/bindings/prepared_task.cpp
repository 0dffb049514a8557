#include "python/bindings/prepared_task.h"

#include <utility>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "skills/observation.h"
#include "skills/tool_command.h"
#include "tasks/task_file.h"

namespace simwright::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;

skills::SkillOptions OptionsOf(const TaskSettings& settings) {
  skills::SkillOptions options;
  options.action = skills::ActionSpaceOf(settings.action_space);
  if (settings.episode_seconds) options.episode_seconds = *settings.episode_seconds;
  if (settings.reach) options.reach = *settings.reach;
  if (settings.turn) options.turn = *settings.turn;
  if (settings.delta_share) options.delta_share = *settings.delta_share;
  if (settings.finger_friction) {
    options.finger_friction = {settings.finger_friction->first, settings.finger_friction->second};
  }
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "settings");
  return options;
}

}  // namespace

PreparedTask::PreparedTask(const std::filesystem::path& file, const std::vector<std::string>& tasks,
                           const TaskSettings& settings) {
  run_.robot = settings.robot;
  run_.options = OptionsOf(settings);
  run_.proved_grasps = settings.proved_grasps;
  run_.set = workflows::ChooseTasks(tasks::ReadTaskFile(file), tasks, file.string());
  skills_ = workflows::PrepareSkills(run_);
}

std::vector<std::string> PreparedTask::SubtaskNames() const {
  std::vector<std::string> names;
  for (const workflows::RunSkill& skill : skills_) names.push_back(skill.name);
  return names;
}

std::vector<std::string> PreparedTask::TaskNames() const {
  std::vector<std::string> names;
  for (const tasks::Task& task : run_.set.tasks) names.push_back(task.name);
  return names;
}

std::string PreparedTask::Description(int subtask) const {
  SkillAt(subtask, true);
  return run_.set.tasks.front().subtasks[static_cast<size_t>(subtask)].description;
}

std::vector<JointRange> PreparedTask::ArmJoints() const {
  const robot::RobotModel& robot = *SkillAt(0, true)->robot;
  std::vector<JointRange> ranges;
  for (size_t j = 0; j < robot.arm.joints.size(); ++j) {
    const auto index = static_cast<size_t>(robot.arm_joints[j]);
    ranges.emplace_back(robot.urdf.joints[index].name, robot.arm.joints[j].lower,
                        robot.arm.joints[j].upper);
  }
  return ranges;
}

std::shared_ptr<const skills::Skill> PreparedTask::SkillAt(int subtask, bool evaluated) const {
  if (subtask < 0 || subtask >= static_cast<int>(skills_.size())) {
    throw core::Error("there is no subtask " + std::to_string(subtask), run_.set.tasks.front().name,
                      "it has " + std::to_string(skills_.size()));
  }
  const workflows::RunSkill& skill = skills_[static_cast<size_t>(subtask)];
  return evaluated ? skill.evaluated : skill.skill;
}

void BindPreparedTask(nb::module_& module) {
  nb::class_<TaskSettings>(module, "TaskSettings", "How the tasks of a file are simulated.")
      .def(nb::init<>())
      .def_rw("robot", &TaskSettings::robot, "panda, panda_on_base, or a URDF with its side file")
      .def_rw("action_space", &TaskSettings::action_space,
              "focus, guided, absolute, delta, joints or joint_targets")
      .def_rw("episode_seconds", &TaskSettings::episode_seconds, "s; None: 8")
      .def_rw("reach", &TaskSettings::reach, "m, for an offset of 1; None: 0.08")
      .def_rw("turn", &TaskSettings::turn, "rad, for a rotation of 1; None: 0.8")
      .def_rw("delta_share", &TaskSettings::delta_share,
              "share of reach and turn of one decision's step with delta and joints; None: 0.25")
      .def_rw("finger_friction", &TaskSettings::finger_friction,
              "(low, high) of the fingers' coefficient, sampled per episode; None: the robot's")
      .def_rw("proved_grasps", &TaskSettings::proved_grasps,
              "whether objects and sliding parts are grasped by their grasps.json");
  nb::class_<PreparedTask>(module, "PreparedTask",
                           "Tasks of a tasks.json, ready to run. Constant and thread-safe.")
      .def(
          "__init__",
          [](PreparedTask* self, const std::filesystem::path& file,
             const std::vector<std::string>& tasks, const TaskSettings& settings) {
            const nb::gil_scoped_release released;
            new (self) PreparedTask(file, tasks, settings);
          },
          "file"_a, "tasks"_a, "settings"_a)
      .def_prop_ro("subtasks", &PreparedTask::SubtaskNames, "names, in order")
      .def_prop_ro("tasks", &PreparedTask::TaskNames, "names")
      .def_prop_ro("arm_joints", &PreparedTask::ArmJoints,
                   "name, lower and upper limit (rad or m) of the arm's joints, root to tool")
      .def("description", &PreparedTask::Description, "subtask"_a)
      .def(
          "observation_size",
          [](const PreparedTask& task, int subtask) {
            const skills::Skill& skill = *task.SkillAt(subtask, true);
            return skills::Observer(skill, skill.variants.front()).size();
          },
          "subtask"_a)
      .def(
          "action_size",
          [](const PreparedTask& task, int subtask) {
            return skills::ActionSize(*task.SkillAt(subtask, true));
          },
          "subtask"_a)
      .def("decision_seconds",
           [](const PreparedTask& task) { return task.run().options.decision_seconds(); })
      .def(
          "decisions", [](const PreparedTask& task) { return task.run().options.decisions(); },
          "Returns the number of steps after which an episode is truncated.");
}

}  // namespace simwright::python
