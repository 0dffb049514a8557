#pragma once

#include <memory>
#include <set>
#include <utility>

struct btOverlapFilterCallback;

namespace simwright::sim {

// Filters pairs of links that do not collide with each other: Bullet's link colliders ignore their
// own exclusion lists. Colliders hold the indices of their body and link.
class ExclusionFilter {
 public:
  ExclusionFilter();
  ~ExclusionFilter();
  ExclusionFilter(const ExclusionFilter&) = delete;
  ExclusionFilter& operator=(const ExclusionFilter&) = delete;

  // Disables the contacts of pairs of links of one body, the lesser index first.
  void Exclude(int body, const std::set<std::pair<int, int>>& pairs);
  // Returns the callback for Bullet's pair cache; the filter owns it.
  btOverlapFilterCallback* callback();

 private:
  class Callback;
  std::unique_ptr<Callback> callback_;
};

}  // namespace simwright::sim
