#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/error.h"
#include "core/files.h"
#include "sim/bodies_mjcf.h"
#include "sim/grasp_rig.h"
#include "sim/mujoco_pose.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {
namespace {

constexpr double kPalmMass = 1.0;      // kg
constexpr double kPalmArmature = 1e5;  // kg and kg m^2: loads do not move the palm
// kg, the reflected inertia of a finger's drive. Contacts are springs that a load deforms by
// (force / inertia) * (time constant)^2: fingers of 30 g alone would sink in by millimetres.
constexpr double kFingerArmature = 0.5;
constexpr double kContactSteps = 2.5;  // time constant of contacts, 5 ms as in the MJCF of assets
// MuJoCo's friction is regularised: without iterations against slip, objects of 150 g creep by
// millimetres in two seconds. At the default impedance of 0.9, light objects sink in by a
// millimetre.
constexpr double kFrictionImpedanceRatio = 10.0;
constexpr int kNoSlipIterations = 4;
constexpr double kImpedance = 0.98;
// kg and s: an object that is lighter than the first is stepped by the second, else by the third.
// The depth to which a force sinks in is inversely proportional to the mass.
constexpr double kLight = 0.05, kLightStep = 0.001, kStep = 0.002;
constexpr int kGripperBody = 0, kObjectBody = 1;  // in the list of placements
constexpr int kNoLink = -1;

// The compiled model, and data that finished rigs return for the next ones.
class GraspModel {
 public:
  GraspModel(const GripperModel& gripper, const GraspRigObject& object,
             const GraspRigOptions& options)
      : object_(object),
        force_(gripper.force),
        scene_(File(gripper, object, options), {}, kGround) {
    mjModel& model = *scene_.model();
    model.opt.gravity[2] = 0.0;
    model.opt.cone = mjCONE_ELLIPTIC;
    model.opt.impratio = kFrictionImpedanceRatio;
    model.opt.noslip_iterations = kNoSlipIterations;
    model.opt.enableflags |= mjENBL_MULTICCD;
    palm_ = Find(mjOBJ_BODY, MjcfName("link", kGripperBody, kPalmLink));
    links_.assign(static_cast<size_t>(model.nbody), kNoLink);
    for (size_t i = 0; i < object.body.links.size(); ++i) {
      const int id = Find(mjOBJ_BODY, MjcfName("link", kObjectBody, i));
      links_[static_cast<size_t>(id)] = static_cast<int>(i);
      ids_.push_back(id);
    }
    for (size_t j = 0; j < object.body.joints().size(); ++j) {
      addresses_.push_back(
          object.body.joints()[j].Moves()
              ? model.jnt_qposadr[Find(mjOBJ_JOINT, MjcfName("joint", kObjectBody, j))]
              : -1);
    }
    for (size_t i = 0; i < 2; ++i) {
      bodies_[i] = Find(mjOBJ_BODY, MjcfName("link", kGripperBody, kFirstFingerLink + i));
      joints_[i] = Find(mjOBJ_JOINT, MjcfName("joint", kGripperBody, i));
      model.dof_armature[model.jnt_dofadr[joints_[i]]] = kFingerArmature;
    }
    for (int i = 0; i < 6; ++i) model.dof_armature[Dof(palm_) + i] = kPalmArmature;
    if (object.joint >= 0) {
      const int joint =
          Find(mjOBJ_JOINT, MjcfName("joint", kObjectBody, static_cast<size_t>(object.joint)));
      model.dof_armature[model.jnt_dofadr[joint]] += object.added_inertia;
    }
    SetContacts(options.friction, gripper.torsion, &model);
    mj_setConst(&model, scene_.data());
  }
  ~GraspModel() {
    for (mjData* data : spare_) mj_deleteData(data);
  }
  GraspModel(const GraspModel&) = delete;
  GraspModel& operator=(const GraspModel&) = delete;

  const mjModel* model() const { return scene_.model(); }
  double force() const { return force_; }
  int palm() const { return palm_; }
  const GraspRigObject& object() const { return object_; }
  // Returns the link of the object that MuJoCo's body is; kNoLink for other bodies.
  int LinkOf(int body) const { return links_[static_cast<size_t>(body)]; }
  int BodyOf(int link) const { return ids_[static_cast<size_t>(link)]; }
  const std::vector<int>& bodies() const { return ids_; }  // by link of the object
  // Returns the place in qpos by joint of the object; -1 for a fixed joint.
  const std::vector<int>& addresses() const { return addresses_; }
  int finger(size_t index) const { return bodies_[index]; }
  int joint(size_t index) const { return joints_[index]; }
  int Dof(int body) const { return model()->jnt_dofadr[model()->body_jntadr[body]]; }
  int Position(int body) const { return model()->jnt_qposadr[model()->body_jntadr[body]]; }

  mjData* Take() const {
    mjData* data = nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (!spare_.empty()) {
        data = spare_.back();
        spare_.pop_back();
      }
    }
    if (data == nullptr) data = mj_makeData(model());
    mj_resetData(model(), data);
    return data;
  }
  void Return(mjData* data) const {
    const std::lock_guard lock(mutex_);
    spare_.push_back(data);
  }

 private:
  static constexpr MujocoScene::Ground kGround = MujocoScene::Ground::kOwn;

  std::filesystem::path File(const GripperModel& gripper, const GraspRigObject& object,
                             const GraspRigOptions& options) const {
    // The damping limits the speed: at finger_speed it takes up the whole force.
    const ArticulatedBody hand =
        GripperBody(gripper, kPalmMass, gripper.force / options.finger_speed);
    const auto identity = Eigen::Isometry3d::Identity();
    const std::filesystem::path path = folder_.path() / "grasp.xml";
    core::WriteFile(
        path, BodiesMjcf({{&hand, identity, false, {}}, {&object.body, identity, object.fixed, {}}},
                         {.time_step = object.moved_mass < kLight ? kLightStep : kStep,
                          .contacts = 300,
                          .rows = 1000,
                          .floor = true}));
    return path;
  }

  void SetContacts(double friction, double torsion, mjModel* model) const {
    for (int geom = 0; geom < model->ngeom; ++geom) {
      model->geom_solref[mjNREF * geom] = kContactSteps * model->opt.timestep;
      model->geom_solref[mjNREF * geom + 1] = 1.0;
      model->geom_solimp[mjNIMP * geom] = kImpedance;
      model->geom_solimp[mjNIMP * geom + 1] = 0.5 * (1.0 + kImpedance);
      const int body = model->geom_bodyid[geom];
      if (body == 0) continue;  // the floor
      model->geom_friction[3 * geom] = friction;
      if (LinkOf(body) != kNoLink) {
        if (object_.fixed) model->geom_conaffinity[geom] &= ~1;
        continue;
      }
      model->geom_conaffinity[geom] &= ~1;  // passes through the floor
      if (body == palm_) continue;
      model->geom_condim[geom] = 4;  // with torsional friction, of which MuJoCo takes the greater
      model->geom_friction[3 * geom + 1] = friction * torsion;
    }
  }

  int Find(int type, const std::string& name) const {
    const int id = mj_name2id(scene_.model(), type, name.c_str());
    if (id < 0) throw core::Error("the grasp trial has no '" + name + "'");
    return id;
  }

  core::TemporaryFolder folder_;
  GraspRigObject object_;
  double force_;
  MujocoScene scene_;
  int palm_ = -1;
  std::vector<int> links_;      // by MuJoCo's body
  std::vector<int> ids_;        // by link
  std::vector<int> addresses_;  // by joint
  std::array<int, 2> bodies_ = {-1, -1}, joints_ = {-1, -1};
  mutable std::mutex mutex_;
  mutable std::vector<mjData*> spare_;
};

class MujocoGraspRig : public GraspRig {
 public:
  MujocoGraspRig(const GraspModel& compiled, const GraspRigStart& start)
      : compiled_(compiled),
        model_(compiled.model()),
        data_(compiled.Take()),
        tool_(start.world_from_tool),
        target_(start.world_from_tool) {
    WriteMujocoPose(tool_, data_->qpos + compiled_.Position(compiled_.palm()));
    const GraspRigObject& object = compiled_.object();
    if (!object.fixed) {
      WriteMujocoPose(start.world_from_object, data_->qpos + compiled_.Position(RootBody()));
    }
    for (size_t j = 0; j < compiled_.addresses().size(); ++j) {
      if (compiled_.addresses()[j] < 0) continue;
      data_->qpos[compiled_.addresses()[j]] = object.positions[j];
    }
    for (size_t i = 0; i < 2; ++i) {
      data_->qpos[model_->jnt_qposadr[compiled_.joint(i)]] = start.closing;
    }
    mj_forward(model_, data_);
  }
  ~MujocoGraspRig() override { compiled_.Return(data_); }

  void SetGravity(double gravity) override { gravity_ = gravity; }
  void MovePalm(const Eigen::Isometry3d& target) override { target_ = target; }

  void DriveFingers(bool close) override {
    for (size_t i = 0; i < 2; ++i) {
      data_->qfrc_applied[model_->jnt_dofadr[compiled_.joint(i)]] =
          close ? compiled_.force() : -compiled_.force();
    }
  }

  void Step() override {
    const double step = model_->opt.timestep;
    // The palm is placed exactly on its path; its velocity is what contacts feel.
    WriteMujocoPose(tool_, data_->qpos + compiled_.Position(compiled_.palm()));
    const Eigen::Matrix3d relative = tool_.linear().transpose() * target_.linear();
    const Eigen::AngleAxisd turn(relative);
    double* velocity = data_->qvel + compiled_.Dof(compiled_.palm());
    Eigen::Map<Eigen::Vector3d> linear(velocity), angular(velocity + 3);
    linear = (target_.translation() - tool_.translation()) / step;
    angular = turn.angle() / step * turn.axis();  // MuJoCo takes it in the body's frame
    // Weight alone: MuJoCo keeps gravity in the shared model.
    for (const int body : compiled_.bodies()) {
      data_->xfrc_applied[6 * body + 2] = -gravity_ * model_->body_mass[body];
    }
    mj_step(model_, data_);
    // mj_step leaves the poses of links at the start of the step.
    if (compiled_.object().fixed) mj_kinematics(model_, data_);
    tool_ = target_;
  }

  double time_step() const override { return model_->opt.timestep; }
  Eigen::Isometry3d ToolPose() const override { return tool_; }
  Eigen::Isometry3d ObjectPose() const override {
    const GraspRigObject& object = compiled_.object();
    if (!object.fixed) return ReadMujocoPose(data_->qpos + compiled_.Position(RootBody()));
    const int body = compiled_.BodyOf(object.link);
    const mjtNum* quaternion = data_->xquat + 4 * body;
    Eigen::Isometry3d pose(
        Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]));
    pose.translation() = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body);
    return pose;
  }
  double JointPosition() const override {
    const int joint = compiled_.object().joint;
    return joint < 0 ? 0.0 : data_->qpos[compiled_.addresses()[static_cast<size_t>(joint)]];
  }
  std::array<double, 2> FingerPositions() const override {
    return {data_->qpos[model_->jnt_qposadr[compiled_.joint(0)]],
            data_->qpos[model_->jnt_qposadr[compiled_.joint(1)]]};
  }

  GraspContacts Contacts() const override {
    GraspContacts result;
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      const int a = model_->geom_bodyid[contact.geom1], b = model_->geom_bodyid[contact.geom2];
      const bool first = compiled_.LinkOf(a) != kNoLink;
      const int link = compiled_.LinkOf(first ? a : b);
      const int other = first ? b : a;
      if (link == kNoLink || other == 0) continue;  // the floor
      result.penetration = std::max(result.penetration, -contact.dist);
      if (contact.dist > 0.0 || !compiled_.object().held[static_cast<size_t>(link)]) continue;
      if (other == compiled_.palm()) result.palm = true;
      for (size_t f = 0; f < 2; ++f) {
        if (other == compiled_.finger(f)) result.fingers[f] = true;
      }
    }
    return result;
  }

 private:
  int RootBody() const { return compiled_.BodyOf(0); }

  const GraspModel& compiled_;
  const mjModel* model_;
  mjData* data_;
  Eigen::Isometry3d tool_, target_;  // world_from_tool, now and after the next step
  double gravity_ = 0.0;
};

class MujocoGraspRigSource : public GraspRigSource {
 public:
  MujocoGraspRigSource(const GripperModel& gripper, const GraspRigObject& object,
                       const GraspRigOptions& options)
      : compiled_(gripper, object, options) {}
  std::unique_ptr<GraspRig> Make(const GraspRigStart& start) const override {
    return std::make_unique<MujocoGraspRig>(compiled_, start);
  }

 private:
  GraspModel compiled_;
};

}  // namespace

std::unique_ptr<GraspRigSource> MujocoGraspRigs(const GripperModel& gripper,
                                                const GraspRigObject& object,
                                                const GraspRigOptions& options) {
  return std::make_unique<MujocoGraspRigSource>(gripper, object, options);
}

}  // namespace simwright::sim
