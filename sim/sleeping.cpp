// The sleep of trees at rest in CompactSolver.
#include <algorithm>
#include <cmath>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "sim/compact_solver.h"

namespace simwright::sim {
namespace {

constexpr double kSecondsToSleep = 0.2;

}  // namespace

bool CompactSolver::IsStill(const btCollisionObject& object) const {
  const auto* collider = btMultiBodyLinkCollider::upcast(&object);
  if (collider == nullptr) return true;  // the floor
  const Tree& tree = trees_[static_cast<size_t>(object.getUserIndex())];
  if (!tree.dynamics->Moves(collider->m_link)) return true;
  return !tree.driven && tree.dynamics->still_steps() >= steps_to_sleep_;
}

void CompactSolver::PutToSleep(double dt,
                               const std::vector<std::vector<btCollisionObject*>>& colliders,
                               btOverlappingPairCache* pairs) {
  steps_to_sleep_ = std::max(1, static_cast<int>(std::lround(kSecondsToSleep / dt)));
  for (Tree& tree : trees_) {
    tree.may_sleep = !tree.driven && tree.dynamics->still_steps() >= steps_to_sleep_;
  }
  const btBroadphasePairArray& all = pairs->getOverlappingPairArray();
  for (int i = 0; i < all.size(); ++i) {
    const auto& a = *static_cast<const btCollisionObject*>(all[i].m_pProxy0->m_clientObject);
    const auto& b = *static_cast<const btCollisionObject*>(all[i].m_pProxy1->m_clientObject);
    const bool keeps_a = !IsStill(b), keeps_b = !IsStill(a);
    if (keeps_a && a.getUserIndex() >= 0) {
      trees_[static_cast<size_t>(a.getUserIndex())].may_sleep = false;
    }
    if (keeps_b && b.getUserIndex() >= 0) {
      trees_[static_cast<size_t>(b.getUserIndex())].may_sleep = false;
    }
  }
  for (size_t i = 0; i < trees_.size(); ++i) {
    Tree& tree = trees_[i];
    if (tree.asleep == tree.may_sleep) continue;
    tree.asleep = tree.may_sleep;
    if (tree.asleep) tree.dynamics->Stop();
    for (btCollisionObject* collider : colliders[i]) {
      collider->forceActivationState(tree.asleep ? ISLAND_SLEEPING : ACTIVE_TAG);
    }
  }
}

}  // namespace simwright::sim
