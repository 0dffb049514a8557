#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <btBulletDynamicsCommon.h>

namespace simwright::sim {

// Filters pairs of links that do not collide with each other: Bullet's link colliders ignore their
// own exclusion lists. Colliders hold the indices of their body and link.
class ExclusionFilter : public btOverlapFilterCallback {
 public:
  void Exclude(int body, const std::set<std::pair<int, int>>& pairs) {
    if (!pairs.empty()) pairs_[body] = pairs;
  }
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
        (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0) {
      return false;
    }
    const auto* one = static_cast<const btCollisionObject*>(a->m_clientObject);
    const auto* other = static_cast<const btCollisionObject*>(b->m_clientObject);
    if (one->getUserIndex() != other->getUserIndex()) return true;
    const auto found = pairs_.find(one->getUserIndex());
    return found == pairs_.end() ||
           !found->second.contains(std::minmax(one->getUserIndex2(), other->getUserIndex2()));
  }

 private:
  std::map<int, std::set<std::pair<int, int>>> pairs_;  // by body
};

}  // namespace simwright::sim
