#include "sim/loaded_tree.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace simwright::sim {

struct LoadedTree::Offset {
  btMultiBodyLinkCollider* collider = nullptr;
  int carrier = 0;
  btTransform carrier_from_collider;
};

LoadedTree::LoadedTree() = default;

LoadedTree::~LoadedTree() = default;

void LoadedTree::AddOffsets() {
  for (const bool own : {false, true}) {
    for (size_t i = 0; i < colliders.size(); ++i) {
      const int link = static_cast<int>(i);
      const TreeLink& place = tree->links[i];
      if (!place.offset || !Collider(link) || (place.carrier == link) != own) continue;
      offsets_.push_back({Collider(link), place.carrier, ToBullet(*place.offset)});
    }
  }
}

bool LoadedTree::FollowDynamics() {
  if (!dynamics->UpdatePoses()) return false;
  for (size_t i = 0; i < colliders.size(); ++i) {
    if (!colliders[i]) continue;
    const int link = tree->links[i].bullet;
    const Eigen::Matrix3d& r = dynamics->Rotation(link);
    colliders[i]->setWorldTransform(
        btTransform(btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0),
                                r(2, 1), r(2, 2)),
                    ToBullet(dynamics->Center(link))));
  }
  PlaceColliders();
  return true;
}

void LoadedTree::PlaceColliders() {
  for (const Offset& offset : offsets_) {
    const btTransform& carrier = Collider(offset.carrier)->getWorldTransform();
    offset.collider->setWorldTransform(carrier * offset.carrier_from_collider);
  }
}

}  // namespace simwright::sim
