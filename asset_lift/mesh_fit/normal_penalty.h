#pragma once

#include <utility>
#include <vector>

#include "core/mesh.h"

namespace simwright::asset_lift {

// A penalty on the angle between neighbouring faces, for a fixed topology.
class NormalPenalty {
 public:
  explicit NormalPenalty(const core::TriangleMesh& mesh);

  // Returns the mean of 1 - n0 . n1 over interior edges and adds `weight` times its derivative to
  // `gradient` (N x 3). Zero-area faces are ignored.
  double Add(const std::vector<Eigen::Vector3d>& vertices, double weight,
             std::vector<Eigen::Vector3d>* gradient) const;

 private:
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<std::pair<int, int>> pairs_;  // of triangles that share an edge
};

}  // namespace simwright::asset_lift
