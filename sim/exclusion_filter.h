#pragma once

#include <memory>
#include <set>
#include <utility>

struct btOverlapFilterCallback;

namespace simwright::sim {

// Filters pairs of links that do not collide with each other, before Bullet keeps them as pairs:
// the links of one body, unless it has self-contacts. Bullet's link colliders ignore their own
// exclusion lists, and it asks about each link of a body in each step. Colliders hold the indices
// of their body and link.
class ExclusionFilter {
 public:
  ExclusionFilter();
  ~ExclusionFilter();
  ExclusionFilter(const ExclusionFilter&) = delete;
  ExclusionFilter& operator=(const ExclusionFilter&) = delete;

  // Enables the contacts of links of one body, except those of some pairs, the lesser index first.
  void AllowSelfContacts(int body, const std::set<std::pair<int, int>>& except);
  // Returns the callback for Bullet's pair cache; the filter owns it.
  btOverlapFilterCallback* callback();

 private:
  class Callback;
  std::unique_ptr<Callback> callback_;
};

}  // namespace simwright::sim
