#include "bench/rl/mujoco_task.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::rl {
namespace {

// Simulation steps per action (frame_skip).
int FramesOf(KnownTask task) {
  return task == KnownTask::kReacher ? 2 : 5;
}

}  // namespace

MujocoTask::MujocoTask(KnownTask task, const std::filesystem::path& mjcf, int count) : task_(task) {
  char error[500] = "";
  model_ = mj_loadXML(mjcf.c_str(), nullptr, error, sizeof error);
  if (model_ == nullptr) throw core::Error(error, mjcf.string(), "give Gymnasium's model file");
  worlds_.resize(static_cast<size_t>(count));
  for (World& world : worlds_) world.data = mj_makeData(model_);
}

MujocoTask::~MujocoTask() {
  for (World& world : worlds_) mj_deleteData(world.data);
  mj_deleteModel(model_);
}

Eigen::Vector3d MujocoTask::BodyAt(const World& world, const char* name) const {
  const int body = mj_name2id(model_, mjOBJ_BODY, name);
  return Eigen::Map<const Eigen::Vector3d>(world.data->xpos + 3 * body);
}

// Starts as Gymnasium does: the reacher near its zero pose and a target within 0.2 m; the pusher at
// its zero pose and a cylinder at least 0.17 m from its goal. Speeds are within 0.005.
void MujocoTask::Start(World* world) const {
  mjData* data = world->data;
  mj_resetData(model_, data);
  world->steps = 0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  if (task_ == KnownTask::kReacher) {
    for (int i = 0; i < 2; ++i) data->qpos[i] += core::Uniform(world->rng, -0.1, 0.1);
    do {
      place << core::Uniform(world->rng, -0.2, 0.2), core::Uniform(world->rng, -0.2, 0.2);
    } while (place.norm() >= 0.2);
  } else {
    do {
      place << core::Uniform(world->rng, -0.3, 0.0), core::Uniform(world->rng, -0.2, 0.2);
    } while (place.norm() <= 0.17);
  }
  const int placed = task_ == KnownTask::kReacher ? model_->nq - 2 : model_->nq - 4;
  for (int i = 0; i < 2; ++i) data->qpos[placed + i] = place[i];
  for (int i = 0; i < placed; ++i) data->qvel[i] = core::Uniform(world->rng, -0.005, 0.005);
  mj_forward(model_, data);
}

Eigen::RowVectorXf MujocoTask::Observe(const World& world) const {
  const mjData& data = *world.data;
  Eigen::RowVectorXf observation(observation_size());
  if (task_ == KnownTask::kReacher) {
    const Eigen::Vector3d away = BodyAt(world, "fingertip") - BodyAt(world, "target");
    const double* q = data.qpos;
    Eigen::RowVectorXd values(10);
    values << std::cos(q[0]), std::cos(q[1]), std::sin(q[0]), std::sin(q[1]), q[2], q[3],
        data.qvel[0], data.qvel[1], away.x(), away.y();
    return values.cast<float>();
  }
  for (int i = 0; i < 7; ++i) {
    observation[i] = static_cast<float>(data.qpos[i]);
    observation[7 + i] = static_cast<float>(data.qvel[i]);
  }
  const char* bodies[] = {"tips_arm", "object", "goal"};
  for (int i = 0; i < 3; ++i) {
    observation.segment<3>(14 + 3 * i) = BodyAt(world, bodies[i]).transpose().cast<float>();
  }
  return observation;
}

// Returns Gymnasium's reward for the state after the action in `ctrl`.
double MujocoTask::RewardOf(const World& world) const {
  const double effort =
      Eigen::Map<const Eigen::VectorXd>(world.data->ctrl, model_->nu).squaredNorm();
  if (task_ == KnownTask::kReacher) {
    return -(BodyAt(world, "fingertip") - BodyAt(world, "target")).norm() - effort;
  }
  const Eigen::Vector3d object = BodyAt(world, "object");
  return -0.5 * (object - BodyAt(world, "tips_arm")).norm() -
         (object - BodyAt(world, "goal")).norm() - 0.1 * effort;
}

void MujocoTask::Reset(std::uint64_t seed, Rows* observations) {
  observations->resize(size(), observation_size());
  for (size_t i = 0; i < worlds_.size(); ++i) {
    worlds_[i].rng = core::StreamRng(seed, i);
    Start(&worlds_[i]);
    observations->row(static_cast<Eigen::Index>(i)) = Observe(worlds_[i]);
  }
}

void MujocoTask::Step(const Rows& actions, StepBatch* batch) {
  batch->observations.resize(size(), observation_size());
  batch->last_observations.resize(size(), observation_size());
  batch->rewards.assign(worlds_.size(), 0.0f);
  batch->terminated.assign(worlds_.size(), 0);
  batch->truncated.assign(worlds_.size(), 0);
  batch->success.assign(worlds_.size(), 0);
  core::ParallelFor(size(), [&](int i) {
    const auto at = static_cast<size_t>(i);
    World& world = worlds_[at];
    for (int k = 0; k < model_->nu; ++k) {
      const double* range = model_->actuator_ctrlrange + 2 * k;
      const double share = std::clamp(static_cast<double>(actions(i, k)), -1.0, 1.0);
      world.data->ctrl[k] = 0.5 * (range[0] + range[1] + share * (range[1] - range[0]));
    }
    for (int frame = 0; frame < FramesOf(task_); ++frame) mj_step(model_, world.data);
    mj_rnePostConstraint(model_, world.data);
    batch->rewards[at] = static_cast<float>(RewardOf(world));
    if (++world.steps >= steps()) {
      batch->truncated[at] = 1;
      batch->last_observations.row(i) = Observe(world);
      Start(&world);
    }
    batch->observations.row(i) = Observe(world);
  });
}

std::string MujocoTask::SaveState() const {
  throw core::Error("cannot be saved", "known task");
}

void MujocoTask::RestoreState(std::string_view, Rows*) {
  throw core::Error("cannot be restored", "known task");
}

}  // namespace simwright::rl
