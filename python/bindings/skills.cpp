#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/prepared_task.h"
#include "rl/policy_file.h"
#include "rl/wilson_interval.h"
#include "skills/skill_evaluation.h"
#include "skills/skill_options.h"
#include "workflows/priors/models_folder.h"
#include "workflows/skills/skill_suite.h"
#include "workflows/tasks/long_tasks.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
namespace fs = std::filesystem;

// Returns the actions (n x A) of the observations (n x O).
nb::ndarray<nb::numpy, float> Act(const rl::Policy& policy, const RowsArgument& observations) {
  RequireShape(observations, observations.shape(0),
               static_cast<std::size_t>(policy.observation_size()), "observations");
  const auto rows = static_cast<Eigen::Index>(observations.shape(0));
  const auto columns = static_cast<Eigen::Index>(policy.action_size());
  auto [array, memory] = NewArray<float>({static_cast<size_t>(rows), static_cast<size_t>(columns)});
  {
    const nb::gil_scoped_release released;
    const rl::Rows inputs =
        Eigen::Map<const rl::Rows>(observations.data(), rows, policy.observation_size());
    rl::Rows actions;
    policy.Act(inputs, &actions);
    Eigen::Map<rl::Rows>(memory, rows, columns) = actions;
  }
  return array;
}

nb::ndarray<nb::numpy, float> ActOn(const rl::Policy& policy, nb::handle observations) {
  const char* what = "observations";
  nb::object rows;
  try {
    rows = nb::module_::import_("numpy").attr("ascontiguousarray")(observations,
                                                                   "dtype"_a = "float32");
  } catch (const nb::python_error&) {
    throw core::Error("are not an array of numbers", what, "give (n, O) float32");
  }
  if (nb::cast<int>(rows.attr("ndim")) != 2) {
    throw core::Error("have the shape " + std::string(nb::repr(rows.attr("shape")).c_str()), what,
                      "give (n, O), one row per observation");
  }
  return Act(policy, nb::cast<RowsArgument>(rows));
}

nb::dict CellDict(const workflows::SuiteCell& cell) {
  nb::dict dict;
  dict["name"] = cell.name;
  dict["kind"] = cell.kind;
  dict["pattern"] = cell.pattern;
  dict["subtask"] = cell.subtask;
  dict["robot"] = cell.robot;
  dict["instances"] = cell.instances;
  return dict;
}

nb::dict EvaluationDict(const skills::SkillEvaluation& evaluation) {
  nb::dict dict;
  dict["episodes"] = evaluation.episodes.size();
  dict["successes"] = evaluation.successes;
  dict["success"] = evaluation.rate();
  dict["interval"] = nb::make_tuple(evaluation.interval.low, evaluation.interval.high);
  dict["seconds"] = evaluation.seconds;
  return dict;
}

void BindPolicy(nb::module_& module) {
  nb::class_<rl::Policy>(module, "Policy", "A trained policy, frozen; thread-safe.")
      .def(
          "act", &ActOn, "observations"_a.none(),
          "Returns the mean actions (n, A) float32 in [-1, 1] of `observations` (n, O) float32.\n\n"
          "Raises:\n    Error: for another number of columns.")
      .def_prop_ro("observation_size", &rl::Policy::observation_size, "O")
      .def_prop_ro("action_size", &rl::Policy::action_size, "A")
      .def_prop_ro("metadata", &rl::Policy::metadata, "What the file states (str to str).")
      .def_prop_ro(
          "action_space",
          [](const rl::Policy& policy) { return skills::NameOf(workflows::ActionSpaceOf(policy)); },
          "The action space of its actions, for the environment that it acts in (str).")
      .def_prop_ro(
          "std",
          [](nb::handle self) {
            const auto& policy = nb::cast<const rl::Policy&>(self);
            return View(policy.std().data(), {static_cast<size_t>(policy.action_size())}, self);
          },
          "The standard deviations (A) of training, for callers that sample actions.");
  module.def("read_policy", &rl::ReadPolicy, "path"_a,
             "Reads a policy file.\n\nRaises:\n    Error: if it is missing or damaged.");
}

void BindSuite(nb::module_& module) {
  module.def(
      "cells",
      [] {
        nb::list cells;
        for (const workflows::SuiteCell& cell : workflows::SkillSuite()) {
          cells.append(CellDict(cell));
        }
        return cells;
      },
      "Returns the cells of the skill suite, one dict each.");
  module.def(
      "long_tasks",
      [] {
        nb::list tasks;
        for (const workflows::LongTask& task : workflows::LongTasks()) {
          nb::dict dict;
          dict["name"] = task.name;
          dict["kinds"] = task.kinds;
          dict["task"] = task.task;
          dict["robot"] = task.robot;
          tasks.append(dict);
        }
        return tasks;
      },
      "Returns the tasks of several subtasks that the program ships.");
  module.def("shipped_policy_path", &workflows::ShippedPolicy, "models"_a, "cell"_a);
  module.def("models_folder", &workflows::ModelsFolder);
  module.def(
      "make_cell_tasks",
      [](const std::string& cell, std::uint64_t seed, int count, const fs::path& photo,
         const fs::path& folder, const nb::object& report) {
        const workflows::SuiteCell& known = workflows::CellOf(cell);
        return RunLong(report, [&](core::Progress* progress) {
          return workflows::MakeCellTasks(known, seed, count, photo, folder, progress);
        });
      },
      "cell"_a, "seed"_a, "count"_a, "photo"_a, "folder"_a, "report"_a = nb::none());
  module.def(
      "make_long_task",
      [](const std::string& name, const fs::path& folder, const nb::object& report) {
        const workflows::LongTask& task = workflows::LongTaskOf(name);
        return RunLong(report, [&](core::Progress* progress) {
          return workflows::MakeLongTask(task, folder, progress);
        });
      },
      "name"_a, "folder"_a, "report"_a = nb::none());
}

void BindEvaluation(nb::module_& module) {
  module.def(
      "evaluate",
      [](const PreparedTask& task, int subtask, const rl::Policy* policy, int episodes,
         std::uint64_t seed, const nb::object& report) {
        if (episodes < 1) throw core::Error("must be at least 1", "episodes");
        const skills::Skill& skill = *task.SkillAt(subtask, true);
        return EvaluationDict(RunLong(report, [&](core::Progress* progress) {
          progress->Stage("evaluate " + task.SubtaskNames().at(static_cast<size_t>(subtask)));
          const auto starts = skills::SampleStarts(skill, episodes, seed);
          return policy ? skills::Evaluate(skill, *policy, starts)
                        : skills::EvaluateScriptedExpert(skill, starts);
        }));
      },
      "task"_a, "subtask"_a, "policy"_a.none(), "episodes"_a, "seed"_a, "report"_a = nb::none(),
      "Runs `policy`, or the scripted expert if it is None, from sampled starts.");
  module.def(
      "wilson_interval",
      [](int successes, int count) {
        const rl::Interval interval = rl::WilsonInterval(successes, count);
        return nb::make_tuple(interval.low, interval.high);
      },
      "successes"_a, "count"_a, "Returns the 95 % Wilson interval of a success rate.");
}

}  // namespace

void BindSkills(nb::module_& module) {
  BindPolicy(module);
  BindPreparedTask(module);
  BindSuite(module);
  BindEvaluation(module);
}

}  // namespace simwright::python
