#include <algorithm>
#include <iomanip>
#include <sstream>

#include <mujoco/mujoco.h>

#include "assets/primitive_meshes.h"
#include "sim/body_rig.h"
#include "sim/mujoco_pose.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {
namespace {

// Returns the boxes as MJCF bodies, meshes as the body's own parts are: MuJoCo 2.2 finds fewer
// contacts between a box and a mesh than between two meshes. MuJoCo takes the greater of two
// frictions, so the body's applies.
std::string BoxElements(const std::vector<RigBox>& boxes, double friction) {
  std::ostringstream meshes, bodies;
  meshes << std::setprecision(17);
  bodies << std::setprecision(17);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const RigBox& box = boxes[i];
    const std::string name = "_rig_box_" + std::to_string(i);
    meshes << "<mesh name=\"" << name << "\" vertex=\"";
    for (const Eigen::Vector3d& vertex : assets::BoxMesh(box.size).vertices) {
      meshes << vertex.transpose() << ' ';
    }
    meshes << "\"/>";
    const Eigen::Quaterniond turn(box.world_from_box.linear());
    bodies << "<body name=\"" << name << "\" pos=\"" << box.world_from_box.translation().transpose()
           << "\" quat=\"" << turn.w() << ' ' << turn.x() << ' ' << turn.y() << ' ' << turn.z()
           << "\"><freejoint/><geom type=\"mesh\" mesh=\"" << name << "\" mass=\"" << box.mass
           << "\" condim=\"4\" solref=\"0.005 1\" friction=\"" << friction
           << " 1e-4 1e-4\"/></body>";
  }
  if (boxes.empty()) return "";
  return "<asset>" + meshes.str() + "</asset><worldbody>" + bodies.str() + "</worldbody>";
}

class BodyRigInMujoco : public BodyRig {
 public:
  BodyRigInMujoco(const std::filesystem::path& mjcf, const RigidBody& body,
                  const Eigen::Isometry3d& pose, const std::vector<RigBox>& boxes)
      : scene_(mjcf, {}, MujocoScene::Ground::kAdded, BoxElements(boxes, body.friction)),
        model_(*scene_.model()),
        data_(*scene_.data()) {
    WriteMujocoPose(pose, data_.qpos + Address(0));
    mj_forward(&model_, &data_);
  }
  void SetGravity(const Eigen::Vector3d& gravity) override {
    for (int i = 0; i < 3; ++i) scene_.model()->opt.gravity[i] = gravity[i];
  }
  void Step() override { scene_.Step(); }
  double time() const override { return data_.time; }
  double time_step() const override { return model_.opt.timestep; }
  Eigen::Isometry3d Pose(int index) const override {
    return ReadMujocoPose(data_.qpos + Address(index));
  }
  double DeepestPenetration() const override {
    double deepest = 0.0;
    for (int i = 0; i < data_.ncon; ++i) deepest = std::max(deepest, -data_.contact[i].dist);
    return deepest;
  }
  std::vector<std::string> Warnings() const override { return scene_.warnings(); }

 private:
  // The world is MuJoCo's body 0; each of ours has one free joint.
  int Address(int index) const { return model_.jnt_qposadr[model_.body_jntadr[index + 1]]; }

  MujocoScene scene_;
  const mjModel& model_;
  mjData& data_;
};

}  // namespace

std::unique_ptr<BodyRig> MujocoBodyRig(const std::filesystem::path& mjcf, const RigidBody& body,
                                       const Eigen::Isometry3d& world_from_body,
                                       const std::vector<RigBox>& boxes) {
  return std::make_unique<BodyRigInMujoco>(mjcf, body, world_from_body, boxes);
}

}  // namespace simwright::sim
