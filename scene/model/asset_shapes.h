#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "scene/dataset/vocabulary.h"

namespace simwright::scene {

// What the things of a vocabulary look like to a model that knows classes by their shape: points on
// their surfaces, m, in each one's own frame. Class by class, without the empty one.
struct AssetShapes {
  std::vector<std::vector<Eigen::Vector3d>> surfaces;  // (C x P x 3)

  // As many surfaces as the vocabulary has slots, each of `points` finite points.
  bool IsValid(const Vocabulary& vocabulary, int points, std::string* error) const;
};

// `points` of a surface, drawn evenly by area, the same for the same surface. Throws core::Error
// for a mesh without area.
std::vector<Eigen::Vector3d> ShapeOf(const core::TriangleMesh& solid, int points);

}  // namespace simwright::scene
