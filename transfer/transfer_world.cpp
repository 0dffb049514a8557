#include "transfer/transfer_world.h"

#include "assets/kinematic_model.h"

namespace simwright::transfer {

std::vector<geometry::ConvexShape> PartsOf(const assets::SemanticModel& model) {
  const std::vector<Eigen::Isometry3d> poses =
      assets::MakeKinematicModel(model.model)
          ->LinkPoses(std::vector<double>(model.model.joints.size(), 0.0));
  std::vector<geometry::ConvexShape> parts;
  for (size_t l = 0; l < model.model.links.size(); ++l) {
    for (const assets::UrdfShape& shape : model.model.links[l].collisions) {
      if (shape.mesh.vertices.empty()) continue;
      geometry::ConvexShape& part = parts.emplace_back();
      for (const Eigen::Vector3d& vertex : shape.mesh.vertices) {
        part.vertices.push_back(poses[l] * vertex);
      }
    }
  }
  return parts;
}

std::vector<geometry::ConvexShape> Placed(const std::vector<geometry::ConvexShape>& shapes,
                                          double factor, const Eigen::Isometry3d& pose) {
  std::vector<geometry::ConvexShape> placed = shapes;
  for (geometry::ConvexShape& shape : placed) {
    for (Eigen::Vector3d& vertex : shape.vertices) vertex = pose * (factor * vertex);
  }
  return placed;
}

bool AreApart(const std::vector<geometry::ConvexShape>& one,
              const std::vector<geometry::ConvexShape>& other) {
  if (BoundsOf(one).exteriorDistance(BoundsOf(other)) > 0.0) return true;
  for (const geometry::ConvexShape& a : one) {
    for (const geometry::ConvexShape& b : other) {
      if (!geometry::AreApart(a, b, 0.0)) return false;
    }
  }
  return true;
}

Eigen::AlignedBox3d BoundsOf(const std::vector<geometry::ConvexShape>& shapes) {
  Eigen::AlignedBox3d box;
  for (const geometry::ConvexShape& shape : shapes) {
    for (const Eigen::Vector3d& vertex : shape.vertices) box.extend(vertex);
  }
  return box;
}

}  // namespace simwright::transfer
