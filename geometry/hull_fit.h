#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {

// Measures how far a hull that stands for a part of one solid departs from that solid: CoACD's
// concavity, with the solid itself in the place of the piece, so that the caps between pieces
// count for nothing. Queries are const and safe from several threads.
class HullFit {
 public:
  // `solid` closed and outward. `samples` points on it serve as what a hull may bury.
  HullFit(const core::TriangleMesh& solid, int samples, std::uint64_t seed);

  // max(Hausdorff distance, 0.3 Rv), in units of half the solid's longest side. The Hausdorff
  // distance is that of points on `hull` outside the solid to the solid's surface, and of points
  // on the solid's surface inside `hull` to the hull's. `volume` (m^3) is that of the piece.
  // Once above `enough` the search for a larger distance ends.
  double Concavity(const core::TriangleMesh& hull, double volume, double enough) const;

  // 0.3 Rv alone, Rv the radius of a ball of the volume that the hull adds, in the same units.
  double VolumeConcavity(double excess_volume) const;

  double unit() const { return unit_; }  // m, half the longest side

 private:
  double Overhang(const core::TriangleMesh& hull, double enough) const;
  double Buried(const core::TriangleMesh& hull, double enough) const;
  bool Outside(const Eigen::Vector3d& p) const;

  core::TriangleMesh solid_;
  TriangleTree tree_;
  std::vector<Eigen::Vector3d> samples_;
  double unit_ = 1.0;
};

// Planes along the faces of a convex mesh that support it: normal . x <= offset inside. (F x 4)
std::vector<Eigen::Vector4d> FacePlanes(const core::TriangleMesh& hull);

// Largest signed height of `p` over any of the planes: negative inside, minus the depth then.
double HeightOver(const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& p);

// Whether `p` is inside the closed, outward surface under `tree`: the first face that a ray from
// it meets is seen from behind.
bool InsideSurface(const core::TriangleMesh& mesh, const TriangleTree& tree,
                   const Eigen::Vector3d& p);

}  // namespace simwright::geometry
