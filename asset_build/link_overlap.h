#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "assets/urdf_reader.h"

namespace simwright::asset_build {

// The rigidly connected link groups of a model and the joints between them.
class LinkGroups {
 public:
  explicit LinkGroups(const assets::UrdfModel& model);

  // Returns true if no moving joint lies between the two.
  bool Rigid(size_t link_a, size_t link_b) const { return top_[link_a] == top_[link_b]; }
  // Returns true if exactly one moving joint lies between the two: parent and child, or links fixed
  // to them.
  bool Adjacent(size_t link_a, size_t link_b) const;
  // Marks the links beyond the joint. (links)
  std::vector<bool> CarriedBy(size_t joint) const;

 private:
  std::vector<int> parent_;  // each link's parent; -1 for the root
  std::vector<size_t> top_;  // the first link of each link's group
};

// Returns the deepest penetration of two links' collision parts (convex), with links at `poses`; m,
// 0 if they do not touch.
double OverlapOf(const assets::UrdfModel& model, const std::vector<Eigen::Isometry3d>& poses,
                 size_t link_a, size_t link_b);

// Returns the lowest point of the link's collision parts, m; infinity if it has none.
double LowestOf(const assets::UrdfLink& link, const Eigen::Isometry3d& pose);

// Marks the links beyond moving joints that support the whole model at zero joint positions because
// the root's group does not reach the floor z = 0, such as a cart's wheels. (links)
std::vector<bool> SupportingLinks(const assets::UrdfModel& model);

// Returns true if model.excluded_pairs contains the two links, in either order.
bool IsExcluded(const assets::UrdfModel& model, size_t link_a, size_t link_b);

}  // namespace simwright::asset_build
