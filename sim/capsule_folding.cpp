#include "sim/capsule_folding.h"

#include <cmath>

#include "assets/primitive_meshes.h"

namespace simwright::sim {
namespace {

using assets::UrdfGeometry;
using assets::UrdfShape;

constexpr double kTolerance = 1e-6;  // m: rounding in files

// Returns the unused sphere of `radius` around `center`; -1: none.
int SphereAt(const std::vector<UrdfShape>& shapes, const std::vector<bool>& used,
             const Eigen::Vector3d& center, double radius) {
  for (size_t i = 0; i < shapes.size(); ++i) {
    const UrdfShape& shape = shapes[i];
    if (used[i] || shape.geometry != UrdfGeometry::kSphere) continue;
    if (std::abs(shape.radius - radius) > kTolerance) continue;
    if ((shape.link_from_primitive.translation() - center).norm() < kTolerance) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

void AddCapsule(const core::TriangleMesh& mesh, const std::optional<Capsule>& capsule,
                RigidBody* body) {
  body->capsules.resize(body->parts.size());
  body->parts.push_back(mesh);
  body->capsules.push_back(capsule);
}

}  // namespace

void AddShapes(const std::vector<UrdfShape>& shapes, RigidBody* body) {
  std::vector<bool> used(shapes.size(), false);
  for (size_t i = 0; i < shapes.size(); ++i) {
    const UrdfShape& shape = shapes[i];
    if (shape.geometry != UrdfGeometry::kCylinder) continue;
    const Eigen::Vector3d half = 0.5 * shape.length * Eigen::Vector3d::UnitZ();
    const Capsule capsule{shape.link_from_primitive * half,
                          shape.link_from_primitive * Eigen::Vector3d(-half), shape.radius};
    const int upper = SphereAt(shapes, used, capsule.a, capsule.radius);
    if (upper < 0) continue;
    used[static_cast<size_t>(upper)] = true;
    const int lower = SphereAt(shapes, used, capsule.b, capsule.radius);
    used[static_cast<size_t>(upper)] = lower >= 0;
    if (lower < 0) continue;
    used[i] = used[static_cast<size_t>(lower)] = true;
    core::TriangleMesh mesh = assets::CapsuleMesh(shape.radius, shape.length);
    core::Transform(Eigen::Affine3d(shape.link_from_primitive), &mesh);
    AddCapsule(mesh, capsule, body);
  }
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (used[i]) continue;
    const UrdfShape& shape = shapes[i];
    std::optional<Capsule> capsule;
    if (shape.geometry == UrdfGeometry::kSphere) {
      const Eigen::Vector3d center = shape.link_from_primitive.translation();
      capsule = Capsule{center, center, shape.radius};
    }
    AddCapsule(shape.mesh, capsule, body);
  }
}

}  // namespace simwright::sim
