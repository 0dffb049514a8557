#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/error.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/episodes.h"
#include "skills/observation.h"
#include "skills/scripted_expert.h"
#include "skills/skill_evaluation.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
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

// Throws core::Error unless the cameras were made for this skill.
void RequireCamerasOf(const skills::Skill& skill, const skills::EpisodeCameras& cameras) {
  if (&cameras.skill() == &skill) return;
  throw core::Error("are of another subtask, or of another kind of starts", "cameras",
                    "make them for this one");
}

void RequireCameras(const std::shared_ptr<const skills::EpisodeCameras>& cameras) {
  if (!cameras) throw core::Error("has no cameras", "the environment", "attach some first");
}

}  // namespace

VectorEpisodes::VectorEpisodes(const PreparedTask& task, int subtask, int count, bool evaluated)
    : environment_(task.SkillAt(subtask, evaluated), count) {}

void VectorEpisodes::RequireStarted() const {
  if (!started_) throw core::Error("was not reset", "the environment", "call reset() first");
}

void VectorEpisodes::AttachCameras(std::shared_ptr<const skills::EpisodeCameras> cameras,
                                   const std::vector<std::string>& names,
                                   const std::vector<std::string>& kinds) {
  const ExclusiveUse use(&used_, kName);
  RequireCamerasOf(environment_.skill(), *cameras);
  last_choice_ = ImageChoice::Of(*cameras, names, kinds);
  cameras_ = std::move(cameras);
  views_.assign(static_cast<size_t>(size()), skills::EpisodeView(cameras_));
  environment_.SetEndListener(
      [this](int index, const skills::Episode& episode) { LookAtEnd(index, episode); });
}

FloatArray VectorEpisodes::Reset(std::uint64_t seed) {
  const ExclusiveUse use(&used_, kName);
  rl::Rows observations;
  {
    const nb::gil_scoped_release released;
    environment_.Reset(seed, &observations);
    seed_ = seed;
    started_ = true;
    batch_ = {};
  }
  return CopyOf(observations);
}

nb::tuple VectorEpisodes::Step(const RowsArgument& actions) {
  const ExclusiveUse use(&used_, kName);
  RequireStarted();
  RequireShape(actions, static_cast<size_t>(size()), static_cast<size_t>(action_size()), "actions");
  {
    const nb::gil_scoped_release released;
    actions_ = Eigen::Map<const rl::Rows>(actions.data(), size(), action_size());
    if (cameras_) last_images_ = std::make_unique<EpisodeImages>(*cameras_, size(), last_choice_);
    environment_.Step(actions_, &batch_);
  }
  return nb::make_tuple(
      CopyOf(batch_.observations), CopyOf(batch_.rewards), FlagsOf(batch_.terminated),
      FlagsOf(batch_.truncated), FlagsOf(batch_.success),
      EndedOne() ? nb::cast(CopyOf(batch_.last_observations)) : nb::none(),
      FlagsOf(environment_.invalid_actions()), FlagsOf(environment_.failed_physics()));
}

bool VectorEpisodes::EndedOne() const {
  for (size_t i = 0; i < batch_.terminated.size(); ++i) {
    if (batch_.terminated[i] || batch_.truncated[i]) return true;
  }
  return false;
}

void VectorEpisodes::LookAtEnd(int index, const skills::Episode& episode) {
  skills::EpisodeView& view = views_[static_cast<size_t>(index)];
  view.Pose(episode);
  for (int camera = 0; camera < cameras_->size(); ++camera) {
    view.Render(camera, last_images_->At(index, camera));
  }
}

nb::dict VectorEpisodes::Images(const std::vector<std::string>& names,
                                const std::vector<std::string>& kinds) {
  const ExclusiveUse use(&used_, kName);
  RequireStarted();
  RequireCameras(cameras_);
  EpisodeImages images(*cameras_, size(), ImageChoice::Of(*cameras_, names, kinds));
  {
    const nb::gil_scoped_release released;
    skills::RenderEnvironment(environment_, seed_, &views_, images.All());
  }
  return images.Take(false);
}

nb::object VectorEpisodes::LastImages() {
  const ExclusiveUse use(&used_, kName);
  RequireCameras(cameras_);
  if (!EndedOne() || !last_images_) return nb::none();
  return std::exchange(last_images_, nullptr)->Take(false);
}

nb::object VectorEpisodes::Demonstrate() const {
  const ExclusiveUse use(&used_, kName);
  RequireStarted();
  rl::Rows actions;
  if (!environment_.Demonstrate(&actions)) return nb::none();
  return nb::cast(CopyOf(actions));
}

SingleEpisode::SingleEpisode(const PreparedTask& task, int subtask, bool evaluated)
    : skill_(task.SkillAt(subtask, evaluated)),
      episode_(*skill_),
      observation_size_(skills::Observer(*skill_, skill_->variants.front()).size()) {}

void SingleEpisode::RequireStarted() const {
  if (!started_) throw core::Error("has not begun", "the episode", "call reset() first");
}

void SingleEpisode::AttachCameras(std::shared_ptr<const skills::EpisodeCameras> cameras) {
  const ExclusiveUse use(&used_, kName);
  RequireCamerasOf(*skill_, *cameras);
  cameras_ = std::move(cameras);
  view_.emplace(cameras_);
  if (started_) view_->Begin(episode_.start().variant, look_seed_);
}

FloatArray SingleEpisode::Observe() const {
  auto [array, memory] = NewArray<float>({static_cast<size_t>(observation_size_)});
  episode_.Observe(memory);
  return array;
}

FloatArray SingleEpisode::Begin(std::uint64_t seed, std::uint64_t index) {
  const ExclusiveUse use(&used_, kName);
  {
    const nb::gil_scoped_release released;
    rng_ = core::StreamRng(seed, index);
    episode_.Begin(skills::SampleStart(*skill_, rng_));
    look_seed_ = core::StreamRng(seed, index)();
    if (view_) view_->Begin(episode_.start().variant, look_seed_);
    started_ = true;
  }
  return Observe();
}

FloatArray SingleEpisode::BeginAfter(const SingleEpisode& previous) {
  const ExclusiveUse use(&used_, kName), of_previous(&previous.used_, kName);
  previous.RequireStarted();
  {
    const nb::gil_scoped_release released;
    rng_ = previous.rng_;
    look_seed_ = previous.look_seed_;
    episode_.Begin(skills::PlannedFrom(*skill_, skills::EndOf(previous.episode_), rng_,
                                       skills::Resampling::kNothing));
    if (view_) view_->Begin(episode_.start().variant, look_seed_);
    started_ = true;
  }
  return Observe();
}

nb::tuple SingleEpisode::Step(const ActionArgument& action) {
  const ExclusiveUse use(&used_, kName);
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

skills::EpisodeView& SingleEpisode::PosedView() {
  RequireStarted();
  RequireCameras(cameras_);
  view_->Pose(episode_);
  return *view_;
}

nb::dict SingleEpisode::Images(const std::vector<std::string>& names,
                               const std::vector<std::string>& kinds) {
  const ExclusiveUse use(&used_, kName);
  const skills::EpisodeView& view = PosedView();
  EpisodeImages images(*cameras_, 1, ImageChoice::Of(*cameras_, names, kinds));
  {
    const nb::gil_scoped_release released;
    skills::RenderViews({&view}, images.All());
  }
  return images.Take(true);
}

nb::dict SingleEpisode::Camera(const std::string& name) {
  const ExclusiveUse use(&used_, kName);
  const core::Camera camera = PosedView().Camera(cameras_->Find(name));
  nb::dict dict;
  dict["pose"] = Eigen::Matrix4d(camera.world_from_camera.matrix());
  dict["intrinsics"] = nb::make_tuple(camera.fx, camera.fy, camera.cx, camera.cy);
  dict["legend"] = nb::cast(cameras_).attr("legend")(episode_.start().variant);
  return dict;
}

nb::object SingleEpisode::ExpertAction() const {
  const ExclusiveUse use(&used_, kName);
  RequireStarted();
  if (skill_->options.action != skills::ActionSpace::kTargetFrame) return nb::none();
  std::vector<float> action(static_cast<size_t>(ActionSize(*skill_)));
  skills::ExpertAction(episode_, action.data());
  return nb::cast(CopyOf(action));
}

nb::dict SingleEpisode::State() const {
  const ExclusiveUse use(&used_, kName);
  RequireStarted();
  const tasks::WorldState& state = episode_.state();
  const skills::SkillVariant& variant =
      skill_->variants[static_cast<size_t>(episode_.start().variant)];
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
  Eigen::VectorXd positions;
  episode_.world().robot().Positions(&positions);
  nb::dict dict;
  dict["robot_joints"] = positions;
  dict["robot_command"] = Eigen::VectorXd(episode_.command().sent);
  dict["gripper_pose"] = Eigen::Matrix4d(state.gripper.matrix());
  dict["gripper_opening"] = state.opening;
  dict["grasped"] = state.grasped;
  dict["objects"] = objects;
  dict["target"] =
      variant.target ? variant.model.objects[static_cast<size_t>(variant.target->object)].name : "";
  dict["seconds"] = episode_.seconds();
  return dict;
}

void BindEnvironments(nb::module_& module) {
  nb::class_<VectorEpisodes>(
      module, "VectorEpisodes",
      "N episodes of a subtask, each restarted in the step in which it ends.")
      .def(nb::init<const PreparedTask&, int, int, bool>(), "task"_a, "subtask"_a, "count"_a,
           "evaluated"_a = false)
      .def("attach_cameras", &VectorEpisodes::AttachCameras, "cameras"_a, "names"_a, "kinds"_a)
      .def("reset", &VectorEpisodes::Reset, "seed"_a, "Restarts all episodes; returns (N, O).")
      .def("step", &VectorEpisodes::Step, "actions"_a,
           "Executes `actions` (N, A) float32, clamped to [-1, 1]. Returns observations (N, O), "
           "rewards (N), terminated, truncated and success (N, bool), the last observations of "
           "ended episodes (N, O) or None, and the flags of invalid actions and failed physics.")
      .def("images", &VectorEpisodes::Images, "names"_a, "kinds"_a)
      .def("last_images", &VectorEpisodes::LastImages)
      .def("demonstrate", &VectorEpisodes::Demonstrate,
           "Returns the scripted expert's actions (N, A), or None.")
      .def_prop_ro("size", &VectorEpisodes::size)
      .def_prop_ro("observation_size", &VectorEpisodes::observation_size)
      .def_prop_ro("action_size", &VectorEpisodes::action_size);
  nb::class_<SingleEpisode>(module, "SingleEpisode", "One episode at a time of a subtask.")
      .def(nb::init<const PreparedTask&, int, bool>(), "task"_a, "subtask"_a, "evaluated"_a = false)
      .def("attach_cameras", &SingleEpisode::AttachCameras, "cameras"_a)
      .def("begin", &SingleEpisode::Begin, "seed"_a, "index"_a = 0)
      .def("begin_after", &SingleEpisode::BeginAfter, "previous"_a)
      .def("step", &SingleEpisode::Step, "action"_a)
      .def("images", &SingleEpisode::Images, "names"_a, "kinds"_a)
      .def("camera", &SingleEpisode::Camera, "name"_a)
      .def("expert_action", &SingleEpisode::ExpertAction)
      .def("state", &SingleEpisode::State);
}

}  // namespace simwright::python
