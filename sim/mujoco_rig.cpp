#include <algorithm>
#include <cmath>
#include <map>

#include <mujoco/mujoco.h>

#include "core/error.h"
#include "sim/joint_rig.h"
#include "sim/mujoco_pose.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {
namespace {

// The armature (kg and kg m^2) that fixes a free root: 40 kg then fall at 0.4 mm/s^2, while its
// links still feel their weight. With a thousand times more, the solver loses a button's friction
// to rounding.
constexpr double kHeldInertia = 1e6;

constexpr double kRiseTime = 0.1;  // s, until a motor's target reaches its full speed

class RigInMujoco : public JointRig {
 public:
  RigInMujoco(const ArticulatedBody& body, const std::filesystem::path& mjcf,
              const RigOptions& options)
      : body_(body), scene_(mjcf), model_(scene_.model()), data_(scene_.data()) {
    for (const RigidBody& link : body_.links) bodies_.push_back(Find(mjOBJ_BODY, link.name, mjcf));
    for (const assets::Joint& joint : body_.joints()) {
      joints_.push_back(joint.Moves() ? Find(mjOBJ_JOINT, joint.name, mjcf) : -1);
    }
    const int first = model_->body_jntadr[bodies_[0]];
    free_ = model_->body_jntnum[bodies_[0]] == 1 && model_->jnt_type[first] == mjJNT_FREE;
    if (options.hold_root) {
      double* height = free_ ? data_->qpos + model_->jnt_qposadr[first] + 2
                             : model_->body_pos + 3 * bodies_[0] + 2;
      *height += kHeldHeight;
    }
    if (free_ && options.hold_root) {
      for (int i = 0; i < 6; ++i)
        model_->dof_armature[model_->jnt_dofadr[first] + i] = kHeldInertia;
      mj_setConst(model_, data_);
    }
    model_->opt.disableflags |= mjDSBL_FILTERPARENT;  // a door collides with its body
    damping_.assign(model_->dof_damping, model_->dof_damping + model_->nv);
    mj_forward(model_, data_);
  }

  void SetPosition(int joint, double position) override {
    data_->qpos[model_->jnt_qposadr[Joint(joint)]] = position;
    ZeroVelocities();
  }
  void SetRootPose(const Eigen::Isometry3d& pose) override {
    if (!free_) throw core::Error("a fixed body cannot be moved", body_.name());
    double* q = data_->qpos + model_->jnt_qposadr[model_->body_jntadr[bodies_[0]]];
    WriteMujocoPose(pose, q);
    ZeroVelocities();
  }
  void Drive(int joint, double velocity, double max_force) override {
    Release(joint);
    motors_[joint] = {velocity, max_force, data_->time};
  }
  void Release(int joint) override {
    motors_.erase(joint);
    const int dof = Dof(joint);
    model_->dof_damping[dof] = damping_[static_cast<size_t>(dof)];
    data_->qfrc_applied[dof] = 0.0;
  }
  void Step() override {
    for (const auto& [joint, motor] : motors_) Apply(Dof(joint), motor);
    scene_.Step();
  }
  double time() const override { return data_->time; }
  double Position(int joint) const override {
    return data_->qpos[model_->jnt_qposadr[Joint(joint)]];
  }
  double Velocity(int joint) const override { return data_->qvel[Dof(joint)]; }

  Eigen::Isometry3d LinkPose(int link) const override {
    const int b = bodies_.at(static_cast<size_t>(link));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * b);
    const double* q = data_->xquat + 4 * b;
    pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    return pose;
  }

  std::set<std::string> Touching() const override {
    std::set<std::string> pairs;
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      if (contact.dist > 0.0) continue;
      const int a = LinkOf(contact.geom1), b = LinkOf(contact.geom2);
      const bool floor = a < 0 || b < 0;
      const int link = std::max(a, b);
      if (floor ? link == 0 : body_.kinematics->RigidlyJoined(a, b)) continue;
      pairs.insert(floor ? LinkPair(Name(link), "floor") : LinkPair(Name(a), Name(b)));
    }
    return pairs;
  }

  assets::Inertial LoadedInertial(int link) const override {
    const int b = bodies_.at(static_cast<size_t>(link));
    assets::Inertial inertial;
    inertial.mass = model_->body_mass[b];
    inertial.center_of_mass = Eigen::Map<const Eigen::Vector3d>(model_->body_ipos + 3 * b);
    const double* q = model_->body_iquat + 4 * b;
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    inertial.inertia =
        R * Eigen::Map<const Eigen::Vector3d>(model_->body_inertia + 3 * b).asDiagonal() *
        R.transpose();
    return inertial;
  }
  std::vector<std::string> Warnings() const override { return scene_.warnings(); }

 private:
  struct Motor {
    double velocity = 0.0, max_force = 0.0;
    double start = 0.0;  // s
  };
  // Applies a motor. Near and beyond its target velocity the motor is force = gain (target - v),
  // added to MuJoCo's implicit damping: stable for any inertia. Farther below the target it applies
  // its full force. The target rises from zero, so that a light joint follows it instead of being
  // thrown by the full force.
  void Apply(int dof, const Motor& motor) {
    const double rise =
        std::min(1.0, (data_->time - motor.start + model_->opt.timestep) / kRiseTime);
    const double gain = 10.0 * motor.max_force / std::max(std::abs(motor.velocity), 1e-6);
    const double target = rise * motor.velocity;
    const double force = gain * (target - data_->qvel[dof]);
    const bool all = std::abs(force) > motor.max_force && force * motor.velocity > 0.0;
    model_->dof_damping[dof] = damping_[static_cast<size_t>(dof)] + (all ? 0.0 : gain);
    data_->qfrc_applied[dof] = all ? std::copysign(motor.max_force, force) : gain * target;
  }
  int Find(int type, const std::string& name, const std::filesystem::path& mjcf) const {
    const int id = mj_name2id(model_, type, name.c_str());
    if (id < 0) throw core::Error("has no '" + name + "'", mjcf.string(), "write the file again");
    return id;
  }
  int Joint(int joint) const {
    const int id = joints_.at(static_cast<size_t>(joint));
    if (id < 0) throw core::Error("a fixed joint has no position", body_.name());
    return id;
  }
  int Dof(int joint) const { return model_->jnt_dofadr[Joint(joint)]; }
  const std::string& Name(int link) const { return body_.links[static_cast<size_t>(link)].name; }
  int LinkOf(int geom) const {
    for (size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i] == model_->geom_bodyid[geom]) return static_cast<int>(i);
    }
    return -1;
  }
  void ZeroVelocities() {
    mju_zero(data_->qvel, model_->nv);
    mju_zero(data_->qacc_warmstart, model_->nv);
    mj_forward(model_, data_);
  }

  const ArticulatedBody body_;
  MujocoScene scene_;
  mjModel* model_;
  mjData* data_;
  std::vector<int> bodies_;      // by link
  std::vector<int> joints_;      // by joint; -1 where it is fixed
  std::vector<double> damping_;  // from the file, by degree of freedom
  std::map<int, Motor> motors_;  // by joint
  bool free_ = false;
};

}  // namespace

std::unique_ptr<JointRig> MujocoRig(const ArticulatedBody& body, const std::filesystem::path& mjcf,
                                    const RigOptions& options) {
  return std::make_unique<RigInMujoco>(body, mjcf, options);
}

}  // namespace simwright::sim
