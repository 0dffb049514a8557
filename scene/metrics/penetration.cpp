#include "scene/metrics/penetration.h"

#include <algorithm>

#include "scene/feasibility/narrow_phase.h"

namespace simwright::scene {
namespace {

geometry::ConvexShape ObjectBox(const std::vector<geometry::ConvexShape>& parts) {
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

// Returns the pairs of parts that are closer than `within`, m.
std::vector<NarrowPhasePair> ClosePairs(const ConvexBodies& bodies, double within) {
  std::vector<NarrowPhasePair> near;
  const std::vector<Eigen::Vector3d> unmoved(static_cast<size_t>(bodies.size()),
                                             Eigen::Vector3d::Zero());
  bodies.Find(unmoved, within, &near);
  return near;
}

}  // namespace

double TotalPenetration(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        BodyShape shape) {
  ConvexBodies bodies;
  for (const SceneObject& object : objects) {
    const std::vector<geometry::ConvexShape>& parts = asset_set.At(object.category).parts;
    if (shape == BodyShape::kParts) {
      bodies.Add(parts, object.world_from_object, object.welded);
    } else {
      bodies.Add({ObjectBox(parts)}, object.world_from_object, object.welded);
    }
  }
  double sum = 0.0;
  for (const NarrowPhasePair& pair : ClosePairs(bodies, 0.0)) {
    sum += std::max(0.0, -pair.distance);
  }
  return sum;
}

std::vector<PenetratingPair> PenetratingPairs(const std::vector<SceneObject>& objects,
                                              const AssetSet& asset_set, double depth) {
  ConvexBodies bodies;
  for (const SceneObject& object : objects) {
    bodies.Add(asset_set.At(object.category).parts, object.world_from_object, object.welded);
  }
  std::vector<PenetratingPair> pairs;
  for (const NarrowPhasePair& near : ClosePairs(bodies, -depth)) {
    const auto a = static_cast<size_t>(near.a), b = static_cast<size_t>(near.b);
    if (pairs.empty() || pairs.back().a != a || pairs.back().b != b) pairs.push_back({a, b, 0.0});
    pairs.back().depth = std::max(pairs.back().depth, -near.distance);
  }
  return pairs;
}

}  // namespace simwright::scene
