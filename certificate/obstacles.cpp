#include "certificate/obstacles.h"

namespace simwright::certificate {
namespace {

bool AreBoxesNear(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b, double margin) {
  return ((a.min() - b.max()).array() <= margin).all() &&
         ((b.min() - a.max()).array() <= margin).all();
}

}  // namespace

void PlacedShape::Place(const geometry::ConvexShape& local, const Eigen::Isometry3d& pose) {
  shape.radius = local.radius;
  shape.vertices.resize(local.vertices.size());
  box.setEmpty();
  for (size_t i = 0; i < local.vertices.size(); ++i) {
    shape.vertices[i] = pose * local.vertices[i];
    box.extend(shape.vertices[i]);
  }
  box.min().array() -= local.radius;
  box.max().array() += local.radius;
}

Obstacles::Obstacles(const PlacedScene& scene) : ignored_(scene.bodies.size(), 0) {
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    for (const geometry::ConvexShape& part : scene.bodies[i].model->parts) {
      parts_.emplace_back();
      parts_.back().placed.Place(part, scene.bodies[i].world_from_body);
      parts_.back().body = static_cast<int>(i);
    }
  }
}

int Obstacles::Hit(const PlacedShape& shape, double margin,
                   const std::vector<char>* also_ignored) const {
  for (const Part& part : parts_) {
    if (!AreBoxesNear(part.placed.box, shape.box, margin)) continue;
    const auto body = static_cast<size_t>(part.body);
    if (ignored_[body] || (also_ignored != nullptr && (*also_ignored)[body])) continue;
    if (!geometry::AreApart(part.placed.shape, shape.shape, margin)) return part.body;
  }
  return -1;
}

void Obstacles::Mark(const PlacedShape& shape, double margin, std::vector<char>* near) const {
  for (const Part& part : parts_) {
    char& flag = (*near)[static_cast<size_t>(part.body)];
    if (flag || !AreBoxesNear(part.placed.box, shape.box, margin)) continue;
    if (!geometry::AreApart(part.placed.shape, shape.shape, margin)) flag = 1;
  }
}

}  // namespace simwright::certificate
