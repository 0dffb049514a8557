#include "sim/link_setup.h"

#include <limits>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>

#include "sim/bullet_shape.h"

namespace simwright::sim {
namespace {

// The share of a gear's error that one step corrects, times the world's own share (Bullet
// multiplies the two). Without it the fingers of a gripper drift as a pair.
constexpr double kGearRecovery = 1.0;

}  // namespace

void SetUpLink(const ArticulatedBody& body, const LinkTree& tree, int index, double mass_scale,
               btMultiBody* multi) {
  const size_t i = static_cast<size_t>(index);
  const assets::Joint& joint = body.joints()[i - 1];
  const TreeLink& link = tree.links[i];
  const TreeLink& parent_link = tree.links[static_cast<size_t>(body.kinematics->parents()[i - 1])];
  const TreeLink& carrier = tree.links[static_cast<size_t>(parent_link.carrier)];
  const Eigen::Isometry3d parent_from_principal = carrier.link_from_principal.inverse() *
                                                  parent_link.carrier_from_link *
                                                  joint.parent_from_joint;
  const Eigen::Matrix3d principal_from_link = link.link_from_principal.linear().transpose();
  const Eigen::Quaterniond turn(principal_from_link * parent_from_principal.linear().transpose());
  const btQuaternion this_from_parent(turn.x(), turn.y(), turn.z(), turn.w());
  const btVector3 axis = ToBullet(Eigen::Vector3d(principal_from_link * joint.axis));
  const btVector3 to_pivot = ToBullet(Eigen::Vector3d(parent_from_principal.translation()));
  const btVector3 to_center =
      ToBullet(Eigen::Vector3d(principal_from_link * link.link_from_principal.translation()));
  const double mass = mass_scale * link.mass;
  const btVector3 moments = mass_scale * ToBullet(link.moments);
  const int parent = carrier.bullet;
  // Bullet's root is link -1.
  switch (joint.type) {
    case assets::JointType::kRevolute:
    case assets::JointType::kContinuous:
      multi->setupRevolute(link.bullet, mass, moments, parent, this_from_parent, axis, to_pivot,
                           to_center, false);
      break;
    case assets::JointType::kPrismatic:
      multi->setupPrismatic(link.bullet, mass, moments, parent, this_from_parent, axis, to_pivot,
                            to_center, false);
      break;
    default:
      multi->setupFixed(link.bullet, mass, moments, parent, this_from_parent, to_pivot, to_center);
  }
}

std::unique_ptr<btMultiBodyGearConstraint> GearTo(const assets::JointMimic& mimic, int leader,
                                                  int follower, btMultiBody* multi) {
  const btVector3 zero(0, 0, 0);
  const btMatrix3x3 unturned = btMatrix3x3::getIdentity();
  auto gear = std::make_unique<btMultiBodyGearConstraint>(multi, follower, multi, leader, zero,
                                                          zero, unturned, unturned);
  gear->setGearRatio(-mimic.multiplier);
  gear->setRelativePositionTarget(mimic.offset);
  gear->setErp(kGearRecovery);
  gear->setMaxAppliedImpulse(std::numeric_limits<float>::max());
  return gear;
}

}  // namespace simwright::sim
