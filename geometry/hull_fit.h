#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "geometry/point_lanes.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {

// Measures how far the hull of a part of one solid deviates from that solid: CoACD's concavity,
// computed against the solid instead of the piece, so that the caps between pieces do not count.
// Queries are const and thread-safe.
class HullDeviation {
 public:
  // `solid` must be closed and oriented outward. `samples` points on it serve to measure how deep a
  // hull buries the surface.
  HullDeviation(const core::TriangleMesh& solid, int samples, std::uint64_t seed);

  // Returns max(Hausdorff distance, 0.3 Rv), in units of half the solid's longest side. The
  // Hausdorff distance is the larger of that from points on `hull` outside the solid to the solid's
  // surface and that from points on the solid's surface inside `hull` to the hull's. Rv is that of
  // the volume which the hull adds: the smaller of the hull's volume minus `volume` (m^3, of the
  // part of the solid that the hull is known to contain) and of the hull's volume outside the
  // solid, by sample points (a ten-thousandth of the AABB's volume each). The search stops early
  // once the concavity exceeds `enough`; the result is then a lower bound.
  // Rounded to 1e-5, so that ties do not depend on the rounding of the solid's coordinates.
  double Concavity(const core::TriangleMesh& hull, double volume, double enough) const;

  // Returns the Hausdorff distance of Concavity alone, m.
  double Distance(const core::TriangleMesh& hull) const;

  // Returns the sample points on the solid's surface, m.
  const std::vector<Eigen::Vector3d>& samples() const { return samples_; }

  // Returns 0.3 Rv only, where Rv is the radius of a ball of the volume that the hull adds, in the
  // same units.
  double VolumeConcavity(double excess_volume) const;

  // Returns true if `p` (m) lies inside the solid.
  bool Inside(const Eigen::Vector3d& p) const { return !Outside(p); }

  double unit() const { return unit_; }  // m, half the longest side

 private:
  double Measure(const core::TriangleMesh& hull, double volume, double enough) const;
  // Returns the largest distance of a point on `hull` outside the solid to the solid, m, at least
  // `least`. Stops at the first above `enough`.
  double Overhang(const core::TriangleMesh& hull, int points, double least, double enough) const;
  // Both take the hull's face planes.
  double Buried(const core::TriangleMesh& hull, const std::vector<Eigen::Vector4d>& planes,
                double enough) const;
  double OutsideVolume(const core::TriangleMesh& hull,
                       const std::vector<Eigen::Vector4d>& planes) const;
  bool Outside(const Eigen::Vector3d& p) const;

  core::TriangleMesh solid_;
  TriangleTree tree_;
  std::vector<Eigen::Vector3d> samples_;  // on the surface
  PointLanes sample_lanes_;               // the same
  PointLanes outside_;                    // in the AABB, outside the solid
  double sample_volume_ = 0.0;            // m^3, of each of outside_
  double unit_ = 1.0;
};

// Returns the supporting planes of a convex mesh's faces: normal . x <= offset inside. (F x 4)
std::vector<Eigen::Vector4d> FacePlanes(const core::TriangleMesh& hull);

// Returns the largest signed distance of `p` to any of the planes; inside it is minus the depth.
double MaxPlaneDistance(const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& p);

// Returns true if `p` is inside the closed surface under `tree`, oriented outward: the first face
// that a ray from `p` hits is seen from behind.
bool InsideSurface(const core::TriangleMesh& mesh, const TriangleTree& tree,
                   const Eigen::Vector3d& p);

}  // namespace simwright::geometry
