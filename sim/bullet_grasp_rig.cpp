#include <algorithm>
#include <utility>
#include <vector>

#include "sim/articulated_world.h"
#include "sim/grasp_rig.h"

namespace simwright::sim {
namespace {

// kg: 1000 N change the palm's velocity by 40 um/s in a step, before the next one corrects it.
constexpr double kDrivenPalmMass = 1e5;
// A finger that an object stops asks for this speed (m/s): the solver then reaches the full force
// in a few iterations (see DrivenRobot::DriveFingers).
constexpr double kStalledSpeed = 0.7;
constexpr double kSlow = 0.3;  // the share of the finger's speed below which it counts as stopped

class BulletGraspRig : public GraspRig {
 public:
  BulletGraspRig(std::shared_ptr<const PreparedBody> gripper,
                 std::shared_ptr<const PreparedBody> prepared, const GraspRigObject& object,
                 double force, const GraspRigOptions& options, const GraspRigStart& start)
      : object_of_(object), force_(force), speed_(options.finger_speed), world_(Options()) {
    Placement hand{.world_from_root = start.world_from_tool, .fixed = false};
    hand.through_floor = {kPalmLink, kFirstFingerLink, kFirstFingerLink + 1};
    gripper_ = world_.Add(std::move(gripper), hand);
    Placement placement{.world_from_root = start.world_from_object, .fixed = object.fixed};
    for (size_t i = 0; !start.floor && i < object.body.links.size(); ++i) {
      placement.through_floor.push_back(static_cast<int>(i));
    }
    object_ = world_.Add(std::move(prepared), placement);
    for (size_t j = 0; j < object.positions.size(); ++j) {
      const assets::Joint& joint = object.body.joints()[j];
      if (!joint.Moves() || joint.mimic) continue;
      world_.SetPosition(object_, static_cast<int>(j), object.positions[j]);
    }
    for (const int joint : {0, 1}) world_.SetPosition(gripper_, joint, start.closing);
  }

  void SetGravity(double gravity) override {
    gravity_ = gravity;
    world_.SetGravity({0.0, 0.0, -gravity});
  }

  void MovePalm(const Eigen::Isometry3d& target) override {
    const Eigen::Isometry3d now = ToolPose();
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(target.linear() * now.linear().transpose()));
    world_.SetRootVelocity(gripper_, (target.translation() - now.translation()) / time_step(),
                           turn.angle() / time_step() * turn.axis());
    world_.PushRoot(gripper_, Eigen::Vector3d(0.0, 0.0, kDrivenPalmMass * gravity_));
  }

  void DriveFingers(bool close) override {
    for (const int joint : {0, 1}) {
      const bool stalled = close && world_.Velocity(gripper_, joint) < kSlow * speed_;
      const double speed = stalled && touched_ ? kStalledSpeed : speed_;
      world_.Drive(gripper_, joint, close ? speed : -speed, force_);
    }
  }

  void Step() override {
    world_.Step();
    world_.Contacts(&contacts_);
    const GraspContacts now = Contacts();
    touched_ = now.fingers[0] && now.fingers[1];
  }

  double time_step() const override { return world_.time_step(); }
  Eigen::Isometry3d ToolPose() const override { return world_.LinkPose(gripper_, kPalmLink); }
  Eigen::Isometry3d ObjectPose() const override {
    return world_.LinkPose(object_, object_of_.link);
  }
  double JointPosition() const override {
    return object_of_.joint < 0 ? 0.0 : world_.Position(object_, object_of_.joint);
  }
  std::array<double, 2> FingerPositions() const override {
    return {world_.Position(gripper_, 0), world_.Position(gripper_, 1)};
  }

  GraspContacts Contacts() const override {
    GraspContacts result;
    for (const LinkContact& contact : contacts_) {
      const bool gripper_first = contact.body_a == gripper_;
      if ((gripper_first ? contact.body_b : contact.body_a) != object_) continue;
      if (!gripper_first && contact.body_b != gripper_) continue;
      result.penetration = std::max(result.penetration, -contact.distance);
      if (contact.impulse <= 0.0) continue;
      const int link = gripper_first ? contact.link_a : contact.link_b;
      const int touched = gripper_first ? contact.link_b : contact.link_a;
      if (!object_of_.held[static_cast<size_t>(touched)]) continue;
      if (link == kPalmLink) {
        result.palm = true;
      } else {
        result.fingers[static_cast<size_t>(link - kFirstFingerLink)] = true;
      }
    }
    return result;
  }

 private:
  static WorldOptions Options() {
    WorldOptions options;
    options.gravity = 0.0;
    return options;
  }

  const GraspRigObject& object_of_;
  double force_, speed_, gravity_ = 0.0;
  ArticulatedWorld world_;
  int gripper_ = -1, object_ = -1;
  std::vector<LinkContact> contacts_;
  bool touched_ = false;
};

class BulletGraspRigSource : public GraspRigSource {
 public:
  BulletGraspRigSource(const GripperModel& gripper, const GraspRigObject& object,
                       const GraspRigOptions& options)
      : object_of_(object), force_(gripper.force), options_(options) {
    for (RigidBody& link : object_of_.body.links) {
      link.friction = options.friction;  // Bullet multiplies, and the gripper's is 1
      link.rolling_friction = 0.0;
      link.torsional_friction = 0.0;
    }
    object_ = std::make_shared<PreparedBody>(object_of_.body);
    gripper_ = std::make_shared<PreparedBody>(GripperBody(gripper, kDrivenPalmMass, 0.0));
  }
  std::unique_ptr<GraspRig> Make(const GraspRigStart& start) const override {
    return std::make_unique<BulletGraspRig>(gripper_, object_, object_of_, force_, options_, start);
  }

 private:
  GraspRigObject object_of_;
  double force_;
  GraspRigOptions options_;
  std::shared_ptr<const PreparedBody> gripper_, object_;
};

}  // namespace

std::unique_ptr<GraspRigSource> BulletGraspRigs(const GripperModel& gripper,
                                                const GraspRigObject& object,
                                                const GraspRigOptions& options) {
  return std::make_unique<BulletGraspRigSource>(gripper, object, options);
}

}  // namespace simwright::sim
