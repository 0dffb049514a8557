#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "scene/dataset/vocabulary.h"

namespace simwright::scene {

// The asset surfaces of a vocabulary, for a model that identifies classes by shape: points on the
// surfaces, m, in each asset's own frame, class by class without the empty one.
struct AssetShapes {
  std::vector<std::vector<Eigen::Vector3d>> surfaces;  // (C x P x 3)

  // Returns true if there is one surface per category, each of `points` finite points.
  bool IsValid(const Vocabulary& vocabulary, int points, std::string* error) const;
};

// Returns `points` points of a surface, sampled uniformly by area and deterministic for a surface.
// Throws core::Error for a mesh without area.
std::vector<Eigen::Vector3d> ShapeOf(const core::TriangleMesh& solid, int points);

}  // namespace simwright::scene
