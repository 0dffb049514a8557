#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "assets/urdf_reader.h"

namespace simwright::pipeline {

// Which links move together and which ones a joint leads from and to.
class LinkGroups {
 public:
  explicit LinkGroups(const assets::UrdfModel& model);

  // No moving joint lies between the two.
  bool Rigid(size_t link_a, size_t link_b) const { return top_[link_a] == top_[link_b]; }
  // Exactly one moving joint lies between them: parent and child, or what is fixed to them.
  bool Adjacent(size_t link_a, size_t link_b) const;
  // Links beyond the joint. (links)
  std::vector<bool> CarriedBy(size_t joint) const;

 private:
  std::vector<int> parent_;   // of each link; -1 for the root
  std::vector<size_t> top_;   // of the links that move with it, the first
};

// Deepest overlap of two links' collision parts (convex), links at `poses`; m, 0 where they are
// apart.
double OverlapOf(const assets::UrdfModel& model, const std::vector<Eigen::Isometry3d>& poses,
                 size_t link_a, size_t link_b);

// Lowest point of the link's collision parts, m; infinite where it has none.
double LowestOf(const assets::UrdfLink& link, const Eigen::Isometry3d& pose);

// Links beyond moving joints on which the whole stands, joints at zero, because what the root moves
// with does not reach the floor z = 0: a cart's wheels. (links)
std::vector<bool> LinksThatBear(const assets::UrdfModel& model);

// True where model.excluded_pairs has the two links, in either order.
bool IsExcluded(const assets::UrdfModel& model, size_t link_a, size_t link_b);

}  // namespace simwright::pipeline
