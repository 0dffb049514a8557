#include "sim/mujoco_bodies.h"

#include <string>

#include <mujoco/mujoco.h>

#include "core/error.h"
#include "core/files.h"
#include "sim/bodies_mjcf.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {

struct MujocoBodies::Model {
  Model(const std::vector<MujocoPlacement>& placements, double time_step)
      : scene(File(placements, time_step)) {}

  std::filesystem::path File(const std::vector<MujocoPlacement>& placements, double time_step) {
    const std::filesystem::path path = folder.path() / "bodies.xml";
    core::WriteFile(path, BodiesMjcf(placements, {.time_step = time_step}));
    return path;
  }
  int Find(int type, const char* kind, int body, int index) const {
    const std::string name = MjcfName(kind, static_cast<size_t>(body), static_cast<size_t>(index));
    const int id = mj_name2id(scene.model(), type, name.c_str());
    if (id < 0) throw core::Error("the world has no such joint, motor or link", name);
    return id;
  }

  core::TemporaryFolder folder;
  MujocoScene scene;
};

MujocoBodies::MujocoBodies(const std::vector<MujocoPlacement>& placements, double time_step)
    : model_(std::make_unique<Model>(placements, time_step)) {}

MujocoBodies::~MujocoBodies() = default;

void MujocoBodies::SetPosition(int body, int joint, double position) {
  const mjModel* model = model_->scene.model();
  mjData* data = model_->scene.data();
  data->qpos[model->jnt_qposadr[model_->Find(mjOBJ_JOINT, "joint", body, joint)]] = position;
  mju_zero(data->qvel, model->nv);
  mju_zero(data->qacc_warmstart, model->nv);
  mj_forward(model, data);
}

void MujocoBodies::Hold(int body, int joint, double position) {
  model_->scene.data()->ctrl[model_->Find(mjOBJ_ACTUATOR, "joint", body, joint)] = position;
}

void MujocoBodies::Step() {
  model_->scene.Step();
}

double MujocoBodies::Position(int body, int joint) const {
  const mjModel* model = model_->scene.model();
  return model_->scene.data()
      ->qpos[model->jnt_qposadr[model_->Find(mjOBJ_JOINT, "joint", body, joint)]];
}

Eigen::Isometry3d MujocoBodies::LinkPose(int body, int link) const {
  const int id = model_->Find(mjOBJ_BODY, "link", body, link);
  const mjData* data = model_->scene.data();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * id);
  const double* q = data->xquat + 4 * id;
  pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return pose;
}

int MujocoBodies::ContactCount() const {
  return model_->scene.data()->ncon;
}

}  // namespace simwright::sim
