#include "scene/metrics/penetration.h"

#include <algorithm>

#include "scene/near_parts.h"

namespace simwright::scene {
namespace {

geometry::ConvexShape BoxOf(const std::vector<geometry::ConvexShape>& parts) {
  Eigen::AlignedBox3d box;
  for (const geometry::ConvexShape& part : parts) {
    const Eigen::Vector3d grown = Eigen::Vector3d::Constant(part.radius);
    for (const Eigen::Vector3d& vertex : part.vertices) {
      box.extend(vertex - grown);
      box.extend(vertex + grown);
    }
  }
  geometry::ConvexShape shape;
  for (int i = 0; i < 8; ++i) {
    shape.vertices.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return shape;
}

}  // namespace

double TotalPenetration(const std::vector<DrawnObject>& objects, const Palette& palette,
                        BodyShape shape) {
  ConvexBodies bodies;
  for (const DrawnObject& object : objects) {
    const std::vector<geometry::ConvexShape>& parts = palette.At(object.slot).parts;
    if (shape == BodyShape::kParts) {
      bodies.Add(parts, object.world_from_object, object.welded);
    } else {
      bodies.Add({BoxOf(parts)}, object.world_from_object, object.welded);
    }
  }
  std::vector<NearParts> near;
  const std::vector<Eigen::Vector3d> unmoved(objects.size(), Eigen::Vector3d::Zero());
  bodies.Find(unmoved, 0.0, &near);
  double sum = 0.0;
  for (const NearParts& pair : near) sum += std::max(0.0, -pair.distance);
  return sum;
}

}  // namespace simwright::scene
