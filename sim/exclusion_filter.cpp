#include "sim/exclusion_filter.h"

#include <algorithm>
#include <map>

#include <btBulletDynamicsCommon.h>

namespace simwright::sim {

class ExclusionFilter::Callback : public btOverlapFilterCallback {
 public:
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
        (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0) {
      return false;
    }
    const auto* one = static_cast<const btCollisionObject*>(a->m_clientObject);
    const auto* other = static_cast<const btCollisionObject*>(b->m_clientObject);
    if (one->getUserIndex() != other->getUserIndex()) return true;
    if (one->getUserIndex() < 0) return true;
    const auto found = pairs.find(one->getUserIndex());
    return found != pairs.end() &&
           !found->second.contains(std::minmax(one->getUserIndex2(), other->getUserIndex2()));
  }

  // The excluded pairs by body, of bodies whose links collide with each other.
  std::map<int, std::set<std::pair<int, int>>> pairs;
};

ExclusionFilter::ExclusionFilter() : callback_(std::make_unique<Callback>()) {}

ExclusionFilter::~ExclusionFilter() = default;

void ExclusionFilter::AllowSelfContacts(int body, const std::set<std::pair<int, int>>& except) {
  callback_->pairs[body] = except;
}

btOverlapFilterCallback* ExclusionFilter::callback() {
  return callback_.get();
}

}  // namespace simwright::sim
