#include "manipulation/convex_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;
using Plane = Eigen::Hyperplane<double, 3>;

constexpr double kOnePlane = 1e-9;  // of normals and m: triangles of one face

bool IsKnown(const std::vector<Plane>& planes, const Plane& plane) {
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& known) {
    return (known.coeffs() - plane.coeffs()).squaredNorm() < kOnePlane * kOnePlane;
  });
}

}  // namespace

ConvexPart::ConvexPart(const core::TriangleMesh& mesh) {
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Vector3d& a = mesh.vertices[static_cast<size_t>(triangle[0])];
    const Vector3d normal = (mesh.vertices[static_cast<size_t>(triangle[1])] - a)
                                .cross(mesh.vertices[static_cast<size_t>(triangle[2])] - a);
    if (normal.norm() <= 0.0) continue;
    const Plane plane(normal.normalized(), a);
    if (!IsKnown(faces, plane)) faces.push_back(plane);
  }
}

double ConvexPart::DepthOf(const Vector3d& point) const {
  double depth = std::numeric_limits<double>::infinity();
  for (const Plane& face : faces) {
    depth = std::min(depth, -face.signedDistance(point));
    if (depth <= 0.0) return 0.0;
  }
  return std::isfinite(depth) ? depth : 0.0;
}

BodyParts ConvexPartsOf(const sim::ArticulatedBody& body) {
  BodyParts solids;
  for (const sim::RigidBody& link : body.links) {
    solids.emplace_back(link.parts.begin(), link.parts.end());
  }
  return solids;
}

SurfacePoints::SurfacePoints(std::vector<Vector3d> given) : points(std::move(given)) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  if (points.empty()) return;
  center = box.center();
  for (const Vector3d& point : points) radius = std::max(radius, (point - center).norm());
}

double PenetrationIntoPart(const ConvexPart& solid, const SurfacePoints& surface,
                           const Eigen::Isometry3d& link_from_surface) {
  const Vector3d center = link_from_surface * surface.center;
  if (solid.box.squaredExteriorDistance(center) > surface.radius * surface.radius) return 0.0;
  double deepest = 0.0;
  for (const Vector3d& point : surface.points) {
    const Vector3d local = link_from_surface * point;
    if (solid.box.contains(local)) deepest = std::max(deepest, solid.DepthOf(local));
  }
  return deepest;
}

}  // namespace simwright::manipulation
