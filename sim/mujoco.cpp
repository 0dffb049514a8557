#include "sim/mujoco.h"

#include <cstdlib>
#include <fstream>
#include <mutex>

#include <mujoco/mujoco.h>
#include <unistd.h>

#include "core/error.h"
#include "core/progress.h"

namespace simwright::sim {
namespace fs = std::filesystem;
namespace {

// MuJoCo reports through one global callback; the world whose call is running listens.
thread_local std::vector<std::string>* listening = nullptr;

void Hear(const char* text) {
  if (listening != nullptr) listening->push_back(text);
}

class Listen {
 public:
  explicit Listen(std::vector<std::string>* messages) {
    mju_user_warning = Hear;
    listening = messages;
  }
  ~Listen() { listening = nullptr; }
};

// The asset is included in a scene with a floor. A temporary file, since MuJoCo 2.2 reads files.
class SceneFile {
 public:
  SceneFile(const fs::path& mjcf, const std::vector<double>& balls) {
    const fs::path folder = fs::absolute(mjcf).parent_path();
    std::string pattern = (fs::temp_directory_path() / "simwright_scene_XXXXXX.xml").string();
    const int file = mkstemps(pattern.data(), 4);
    if (file < 0) throw core::Error("cannot write a temporary file", pattern);
    close(file);
    path_ = pattern;
    std::ofstream out(path_);
    out << "<mujoco><compiler angle=\"radian\" meshdir=\"" << folder.string() << "\" texturedir=\""
        << folder.string()
        << "\"/><include file=\""
        // MuJoCo 2.2 puts the scene's folder before any include, also before an absolute one.
        << fs::relative(fs::canonical(mjcf), fs::canonical(path_.parent_path())).string()
        << "\"/><worldbody>"
        << "<geom name=\"floor\" type=\"plane\" size=\"0 0 1\" condim=\"6\" friction=\"0.01 1e-5 "
           "1e-5\"/>";
    for (size_t i = 0; i < balls.size(); ++i) {
      out << "<body name=\"ball_" << i << "\"><freejoint/><geom type=\"sphere\" size=\"" << balls[i]
          << "\" condim=\"4\" solref=\"0.005 1\"/></body>";
    }
    out << "</worldbody></mujoco>\n";
  }
  ~SceneFile() {
    std::error_code code;
    fs::remove(path_, code);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

struct MujocoWorld::Model {
  mjModel* model = nullptr;
  mjData* data = nullptr;
  std::vector<std::string> warnings;
  ~Model() {
    if (data != nullptr) mj_deleteData(data);
    if (model != nullptr) mj_deleteModel(model);
  }
  // The world is body 0 in MuJoCo; each of ours has one free joint.
  int Body(int index) const { return index + 1; }
  int Position(int index) const { return model->jnt_qposadr[model->body_jntadr[Body(index)]]; }
};

MujocoWorld::MujocoWorld(const fs::path& mjcf, const std::vector<double>& balls)
    : model_(std::make_unique<Model>()) {
  if (!fs::exists(mjcf)) throw core::Error("no such file", mjcf.string());
  const SceneFile scene(mjcf, balls);
  char message[1000] = "";
  {
    // The XML compiler keeps global state (locale, last model).
    static std::mutex compiler_mutex;
    const std::lock_guard lock(compiler_mutex);
    const Listen listen(&model_->warnings);
    model_->model = mj_loadXML(scene.path().c_str(), nullptr, message, sizeof(message));
  }
  if (model_->model == nullptr) throw core::Error(message, mjcf.string());
  if (message[0] != '\0') model_->warnings.emplace_back(message);
  model_->data = mj_makeData(model_->model);
}

MujocoWorld::~MujocoWorld() = default;

const std::vector<std::string>& MujocoWorld::warnings() const {
  return model_->warnings;
}

void MujocoWorld::SetPose(int body, const Eigen::Isometry3d& pose) {
  double* q = model_->data->qpos + model_->Position(body);
  const Eigen::Quaterniond rotation(pose.linear());
  Eigen::Map<Eigen::Vector3d> position(q);
  position = pose.translation();
  q[3] = rotation.w();
  q[4] = rotation.x();
  q[5] = rotation.y();
  q[6] = rotation.z();
  mj_forward(model_->model, model_->data);
}

void MujocoWorld::Step() {
  const Listen listen(&model_->warnings);
  mj_step(model_->model, model_->data);
}

double MujocoWorld::time() const {
  return model_->data->time;
}

Eigen::Isometry3d MujocoWorld::Pose(int body) const {
  const double* q = model_->data->qpos + model_->Position(body);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(q);
  pose.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
  return pose;
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
  DropWatch watch(body, options, start);
  while (world.time() < options.settle_time + options.watch_time - 1e-9) {
    world.Step();
    watch.Observe(world.time(), world.Pose(0));
  }
  core::CheckCancelled();
  if (warnings != nullptr) *warnings = world.warnings();
  return watch.Finish();
}

}  // namespace simwright::sim
