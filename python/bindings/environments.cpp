#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "core/error.h"
#include "prepared_task.h"
#include "skills/episode.h"
#include "skills/observation.h"
#include "skills/scripted_expert.h"
#include "skills/skill_environment.h"
#include "skills/skill_evaluation.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
using FloatArray = nb::ndarray<nb::numpy, float>;
using FlagArray = nb::ndarray<nb::numpy, bool>;

FloatArray CopyOf(const rl::Rows& rows) {
  auto [array, memory] =
      NewArray<float>({static_cast<size_t>(rows.rows()), static_cast<size_t>(rows.cols())});
  std::copy(rows.data(), rows.data() + rows.size(), memory);
  return array;
}

FloatArray CopyOf(const std::vector<float>& values) {
  auto [array, memory] = NewArray<float>({values.size()});
  std::copy(values.begin(), values.end(), memory);
  return array;
}

FlagArray FlagsOf(const std::vector<std::uint8_t>& flags) {
  auto [array, memory] = NewArray<bool>({flags.size()});
  std::copy(flags.begin(), flags.end(), memory);
  return array;
}

// N episodes of one subtask; each restarts in the step in which it ends.
class VectorEpisodes {
 public:
  VectorEpisodes(const PreparedTask& task, int subtask, int count, bool evaluated)
      : environment_(task.SkillAt(subtask, evaluated), count) {}
  VectorEpisodes(const VectorEpisodes&) = delete;
  VectorEpisodes& operator=(const VectorEpisodes&) = delete;

  FloatArray Reset(std::uint64_t seed) {
    rl::Rows observations;
    {
      const nb::gil_scoped_release released;
      environment_.Reset(seed, &observations);
      started_ = true;
    }
    return CopyOf(observations);
  }

  nb::tuple Step(const RowsArgument& actions) {
    if (!started_) throw core::Error("was not reset", "the environment", "call reset() first");
    RequireShape(actions, static_cast<size_t>(environment_.size()),
                 static_cast<size_t>(environment_.action_size()), "actions");
    {
      const nb::gil_scoped_release released;
      actions_ = Eigen::Map<const rl::Rows>(actions.data(), environment_.size(),
                                            environment_.action_size());
      environment_.Step(actions_, &batch_);
    }
    return nb::make_tuple(CopyOf(batch_.observations), CopyOf(batch_.rewards),
                          FlagsOf(batch_.terminated), FlagsOf(batch_.truncated),
                          FlagsOf(batch_.success), LastObservations(),
                          FlagsOf(environment_.invalid_actions()),
                          FlagsOf(environment_.failed_physics()));
  }

  nb::object Demonstrate() const {
    if (!started_) throw core::Error("was not reset", "the environment", "call reset() first");
    rl::Rows actions;
    if (!environment_.Demonstrate(&actions)) return nb::none();
    return nb::cast(CopyOf(actions));
  }

  int size() const { return environment_.size(); }
  int observation_size() const { return environment_.observation_size(); }
  int action_size() const { return environment_.action_size(); }

 private:
  // Returns the last observations (N x O) if an episode ended, else None.
  nb::object LastObservations() const {
    for (size_t i = 0; i < batch_.terminated.size(); ++i) {
      if (batch_.terminated[i] || batch_.truncated[i]) {
        return nb::cast(CopyOf(batch_.last_observations));
      }
    }
    return nb::none();
  }

  skills::SkillEnvironment environment_;
  rl::Rows actions_;
  rl::StepBatch batch_;
  bool started_ = false;
};

// One episode at a time of one subtask.
class SingleEpisode {
 public:
  SingleEpisode(const PreparedTask& task, int subtask, bool evaluated)
      : skill_(task.SkillAt(subtask, evaluated)),
        episode_(*skill_),
        observation_size_(skills::Observer(*skill_, skill_->variants.front()).size()) {}
  SingleEpisode(const SingleEpisode&) = delete;
  SingleEpisode& operator=(const SingleEpisode&) = delete;

  // Starts episode `index` of the seed: the one that EvaluateChain and SampleStarts number so.
  FloatArray Begin(std::uint64_t seed, std::uint64_t index) {
    {
      const nb::gil_scoped_release released;
      rng_ = core::StreamRng(seed, index);
      episode_.Begin(skills::SampleStart(*skill_, rng_));
      started_ = true;
    }
    return Observe();
  }

  // Starts where `previous`, of the subtask before, ended.
  FloatArray BeginAfter(const SingleEpisode& previous) {
    previous.RequireStarted();
    {
      const nb::gil_scoped_release released;
      rng_ = previous.rng_;
      episode_.Begin(skills::PlannedFrom(*skill_, skills::EndOf(previous.episode_), rng_,
                                         skills::Resampling::kNothing));
      started_ = true;
    }
    return Observe();
  }

  nb::tuple Step(const nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>& action) {
    RequireStarted();
    if (action.shape(0) != static_cast<size_t>(ActionSize(*skill_))) {
      throw core::Error("has " + std::to_string(action.shape(0)) + " numbers", "action",
                        "give " + std::to_string(ActionSize(*skill_)));
    }
    skills::Decision decision;
    {
      const nb::gil_scoped_release released;
      decision = episode_.Step(action.data());
    }
    return nb::make_tuple(Observe(), decision.reward, decision.terminated, decision.truncated,
                          decision.success, decision.invalid_action,
                          decision.failed && !decision.invalid_action);
  }

  nb::object ExpertAction() const {
    RequireStarted();
    if (skill_->options.action != skills::ActionSpace::kTargetFrame) return nb::none();
    std::vector<float> action(static_cast<size_t>(ActionSize(*skill_)));
    skills::ExpertAction(episode_, action.data());
    return nb::cast(CopyOf(action));
  }

  // Returns the state in SI units, world frame.
  nb::dict State() const {
    RequireStarted();
    const tasks::WorldState& state = episode_.state();
    const skills::SkillVariant& variant = Variant();
    nb::dict objects;
    for (size_t i = 0; i < variant.model.objects.size(); ++i) {
      const tasks::ArticulatedObject& object = variant.model.objects[i];
      nb::dict joints;
      for (size_t j = 0; j < object.joints.size(); ++j) {
        joints[object.joints[j].name.c_str()] = state.joints[i][j];
      }
      nb::dict entry;
      entry["pose"] = Eigen::Matrix4d(state.roots[i].matrix());
      entry["joints"] = joints;
      objects[object.name.c_str()] = entry;
    }
    nb::dict dict;
    Eigen::VectorXd positions;
    episode_.world().robot().Positions(&positions);
    dict["robot_joints"] = positions;
    dict["robot_command"] = Eigen::VectorXd(episode_.command().sent);
    dict["gripper_pose"] = Eigen::Matrix4d(state.gripper.matrix());
    dict["gripper_opening"] = state.opening;
    dict["grasped"] = state.grasped;
    dict["objects"] = objects;
    dict["seconds"] = episode_.seconds();
    return dict;
  }

  std::string TaskObject() const {
    RequireStarted();
    const skills::SkillVariant& variant = Variant();
    if (!variant.target) return "";
    return variant.model.objects[static_cast<size_t>(variant.target->object)].name;
  }

 private:
  void RequireStarted() const {
    if (!started_) throw core::Error("has not begun", "the episode", "call reset() first");
  }
  const skills::SkillVariant& Variant() const {
    return skill_->variants[static_cast<size_t>(episode_.start().variant)];
  }
  FloatArray Observe() const {
    auto [array, memory] = NewArray<float>({static_cast<size_t>(observation_size_)});
    episode_.Observe(memory);
    return array;
  }

  std::shared_ptr<const skills::Skill> skill_;
  skills::Episode episode_;
  core::Rng rng_;
  int observation_size_ = 0;
  bool started_ = false;
};

}  // namespace

void BindEnvironments(nb::module_& module) {
  nb::class_<VectorEpisodes>(module, "VectorEpisodes",
                             "N episodes of a subtask, each restarted in the step in which it ends.")
      .def(nb::init<const PreparedTask&, int, int, bool>(), "task"_a, "subtask"_a, "count"_a,
           "evaluated"_a = false)
      .def("reset", &VectorEpisodes::Reset, "seed"_a, "Restarts all episodes; returns (N, O).")
      .def("step", &VectorEpisodes::Step, "actions"_a,
           "Executes `actions` (N, A) float32, clamped to [-1, 1]. Returns observations (N, O), "
           "rewards (N), terminated, truncated and success (N, bool), the last observations of "
           "ended episodes (N, O) or None, and the flags of invalid actions and failed physics.")
      .def("demonstrate", &VectorEpisodes::Demonstrate,
           "Returns the scripted expert's actions (N, A), or None.")
      .def_prop_ro("size", &VectorEpisodes::size)
      .def_prop_ro("observation_size", &VectorEpisodes::observation_size)
      .def_prop_ro("action_size", &VectorEpisodes::action_size);
  nb::class_<SingleEpisode>(module, "SingleEpisode", "One episode at a time of a subtask.")
      .def(nb::init<const PreparedTask&, int, bool>(), "task"_a, "subtask"_a,
           "evaluated"_a = false)
      .def("begin", &SingleEpisode::Begin, "seed"_a, "index"_a = 0)
      .def("begin_after", &SingleEpisode::BeginAfter, "previous"_a)
      .def("step", &SingleEpisode::Step, "action"_a)
      .def("expert_action", &SingleEpisode::ExpertAction)
      .def("state", &SingleEpisode::State)
      .def_prop_ro("task_object", &SingleEpisode::TaskObject);
}

}  // namespace simwright::python
