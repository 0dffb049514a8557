#pragma once

#include <utility>
#include <vector>

#include "core/mesh.h"

namespace simwright::asset_lift {

// How much neighbouring faces turn against each other, for a fixed topology.
class NormalPenalty {
 public:
  explicit NormalPenalty(const core::TriangleMesh& mesh);

  // The mean over two-faced edges of 1 - n0 . n1; `weight` times its derivative is added to
  // `gradient` (N x 3). Faces without area count for nothing.
  double Add(const std::vector<Eigen::Vector3d>& vertices, double weight,
             std::vector<Eigen::Vector3d>* gradient) const;

 private:
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<std::pair<int, int>> pairs_;  // of triangles that share an edge
};

}  // namespace simwright::asset_lift
