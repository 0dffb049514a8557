#include "sim/body_rig.h"

#include "assets/primitive_meshes.h"
#include "sim/world.h"

namespace simwright::sim {
namespace {

RigidBody BodyOfBox(const RigBox& box) {
  RigidBody body;
  body.name = "box";
  body.parts.push_back(assets::BoxMesh(box.size));
  const Eigen::Vector3d squares = box.size.cwiseAbs2();
  body.inertial.mass = box.mass;
  body.inertial.inertia =
      (box.mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
  body.friction = 1.0;  // Bullet multiplies both sides'
  return body;
}

class BodyRigInBullet : public BodyRig {
 public:
  BodyRigInBullet(const RigidBody& body, const Eigen::Isometry3d& pose,
                  const std::vector<RigBox>& boxes)
      : body_(body) {
    for (const RigBox& box : boxes) boxes_.push_back(BodyOfBox(box));
    world_.Add(body_, pose);
    for (size_t i = 0; i < boxes.size(); ++i) world_.Add(boxes_[i], boxes[i].world_from_box);
  }
  void SetGravity(const Eigen::Vector3d& gravity) override { world_.SetGravity(gravity); }
  void Step() override { world_.Step(); }
  double time() const override { return world_.time(); }
  double time_step() const override { return WorldOptions().time_step; }
  Eigen::Isometry3d Pose(int index) const override { return world_.Pose(index); }
  double DeepestPenetration() const override { return world_.DeepestPenetration(); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  RigidBody body_;
  std::vector<RigidBody> boxes_;
  World world_;
};

}  // namespace

std::unique_ptr<BodyRig> BulletBodyRig(const RigidBody& body,
                                       const Eigen::Isometry3d& world_from_body,
                                       const std::vector<RigBox>& boxes) {
  return std::make_unique<BodyRigInBullet>(body, world_from_body, boxes);
}

}  // namespace simwright::sim
