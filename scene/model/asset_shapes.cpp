#include "scene/model/asset_shapes.h"

#include "geometry/surface_distance.h"

namespace simwright::scene {

bool AssetShapes::IsValid(const Vocabulary& vocabulary, int points, std::string* error) const {
  if (surfaces.size() != vocabulary.categories.size()) {
    *error = "each category needs a surface";
    return false;
  }
  for (size_t i = 0; i < surfaces.size(); ++i) {
    bool valid = static_cast<int>(surfaces[i].size()) == points;
    for (const Eigen::Vector3d& point : surfaces[i]) valid = valid && point.allFinite();
    if (valid) continue;
    *error =
        vocabulary.categories[i] + " does not have " + std::to_string(points) + " finite points";
    return false;
  }
  return true;
}

std::vector<Eigen::Vector3d> ShapeOf(const core::TriangleMesh& solid, int points) {
  return geometry::SampleSurface(solid, points, 1);
}

}  // namespace simwright::scene
