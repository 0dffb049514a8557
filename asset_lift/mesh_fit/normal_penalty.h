#pragma once

#include <utility>
#include <vector>

#include "core/mesh.h"

namespace simwright::asset_lift {

// A penalty on the angle between neighbouring faces, for a fixed topology.
class NormalPenalty {
 public:
  // `crease_angle` (rad): from about this angle on an edge counts as a crease, which costs the same
  // whatever its angle, so that the penalty prefers flat faces and few creases to rounded shapes;
  // 0: there are no creases.
  explicit NormalPenalty(const core::TriangleMesh& mesh, double crease_angle = 0.0);

  // Returns the mean over interior edges of e = 1 - n0 . n1, or with creases of s (1 - exp(-e /
  // s)), where s = 1 - cos(crease_angle) (Welsch's function), and adds `weight` times its
  // derivative to `gradient` (N x 3). Zero-area faces are ignored.
  double Add(const std::vector<Eigen::Vector3d>& vertices, double weight,
             std::vector<Eigen::Vector3d>* gradient) const;

 private:
  double crease_ = 0.0;  // s
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<std::pair<int, int>> pairs_;  // of triangles that share an edge
};

}  // namespace simwright::asset_lift
