#include "sim/joint_rig.h"

#include <algorithm>

#include "sim/articulated_world.h"

namespace simwright::sim {
namespace {

class RigInBullet : public JointRig {
 public:
  RigInBullet(const ArticulatedBody& body, const RigOptions& options) : body_(body) {
    const double height = options.hold_root ? kHeldHeight : 0.0;
    index_ = world_.Add(body_, {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, height)),
                                options.hold_root, options.self_contacts});
  }
  void SetPosition(int joint, double position) override {
    world_.SetPosition(index_, joint, position);
  }
  void SetRootPose(const Eigen::Isometry3d& pose) override { world_.SetRootPose(index_, pose); }
  void Drive(int joint, double velocity, double max_force) override {
    world_.Drive(index_, joint, velocity, max_force);
  }
  void Release(int joint) override { world_.Release(index_, joint); }
  void Step() override { world_.Step(); }
  double time() const override { return world_.time(); }
  double Position(int joint) const override { return world_.Position(index_, joint); }
  double Velocity(int joint) const override { return world_.Velocity(index_, joint); }
  Eigen::Isometry3d LinkPose(int link) const override { return world_.LinkPose(index_, link); }
  std::set<std::string> Touching() const override {
    std::set<std::string> pairs;
    for (const LinkContact& c : world_.Contacts()) {
      if (c.distance > 0.0) continue;
      const bool floor = c.body_a == kFloor || c.body_b == kFloor;
      const int link = c.body_a == kFloor ? c.link_b : c.link_a;
      if (floor ? link == 0 : body_.kinematics->RigidlyJoined(c.link_a, c.link_b)) continue;
      pairs.insert(floor ? LinkPair(Name(link), "floor")
                         : LinkPair(Name(c.link_a), Name(c.link_b)));
    }
    return pairs;
  }
  assets::Inertial LoadedInertial(int link) const override {
    return world_.LoadedInertial(index_, link);
  }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  const std::string& Name(int link) const { return body_.links[static_cast<size_t>(link)].name; }

  const ArticulatedBody body_;
  ArticulatedWorld world_;
  int index_ = 0;
};

}  // namespace

std::unique_ptr<JointRig> BulletRig(const ArticulatedBody& body, const RigOptions& options) {
  return std::make_unique<RigInBullet>(body, options);
}

std::string LinkPair(const std::string& a, const std::string& b) {
  return std::min(a, b) + " and " + std::max(a, b);
}

}  // namespace simwright::sim
