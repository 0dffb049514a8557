#include "sim/mujoco.h"

#include <mujoco/mujoco.h>

#include "core/progress.h"
#include "sim/mujoco_pose.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {
namespace fs = std::filesystem;

std::string MujocoVersion() {
  return mj_versionString();
}

struct MujocoWorld::Model {
  Model(const fs::path& mjcf, const std::vector<double>& balls)
      : scene(mjcf, balls), model(scene.model()), data(scene.data()) {}
  MujocoScene scene;
  mjModel* model;
  mjData* data;
  // The world is body 0 in MuJoCo; each of our bodies has one free joint.
  int Body(int index) const { return index + 1; }
  int Position(int index) const { return model->jnt_qposadr[model->body_jntadr[Body(index)]]; }
};

MujocoWorld::MujocoWorld(const fs::path& mjcf, const std::vector<double>& balls)
    : model_(std::make_unique<Model>(mjcf, balls)) {}

MujocoWorld::~MujocoWorld() = default;

const std::vector<std::string>& MujocoWorld::warnings() const {
  return model_->scene.warnings();
}

void MujocoWorld::SetPose(int body, const Eigen::Isometry3d& pose) {
  WriteMujocoPose(pose, model_->data->qpos + model_->Position(body));
  mj_forward(model_->model, model_->data);
}

void MujocoWorld::Step() {
  model_->scene.Step();
}

double MujocoWorld::time() const {
  return model_->data->time;
}

Eigen::Isometry3d MujocoWorld::Pose(int body) const {
  return ReadMujocoPose(model_->data->qpos + model_->Position(body));
}

assets::Inertial MujocoWorld::LoadedInertial(int body) const {
  const mjModel& m = *model_->model;
  const int b = model_->Body(body);
  assets::Inertial inertial;
  inertial.mass = m.body_mass[b];
  inertial.center_of_mass = Eigen::Map<const Eigen::Vector3d>(m.body_ipos + 3 * b);
  const double* q = m.body_iquat + 4 * b;
  const Eigen::Matrix3d R =
      Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  inertial.inertia =
      R * Eigen::Map<const Eigen::Vector3d>(m.body_inertia + 3 * b).asDiagonal() * R.transpose();
  return inertial;
}

DropResult DropInMujoco(const RigidBody& body, const fs::path& mjcf, const DropOptions& options,
                        std::vector<std::string>* warnings) {
  MujocoWorld world(mjcf);
  const Eigen::Isometry3d start = StartPose(body, options);
  world.SetPose(0, start);
  DropObserver watch(body, options, start);
  while (world.time() < options.settle_time + options.drift_time - 1e-9) {
    world.Step();
    watch.Observe(world.time(), world.Pose(0));
  }
  core::CheckCancelled();
  if (warnings != nullptr) *warnings = world.warnings();
  return watch.Finish();
}

}  // namespace simwright::sim
