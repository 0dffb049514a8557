#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// Where a query met the mesh.
struct SurfacePoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = std::numeric_limits<double>::infinity();  // m; along a ray: from its origin
  int triangle = -1;
};

// The point of triangle abc closest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

// Bounding-volume tree over the triangles of one mesh, for closest points, first hits and overlap.
// Queries are const and safe from several threads.
class TriangleTree {
 public:
  // Keeps a copy of the corners. Throws core::Error on an index out of range or NaN.
  explicit TriangleTree(const core::TriangleMesh& mesh);

  // The closest point within `reach`; triangle -1 where none is. Ties: the lowest triangle.
  SurfacePoint Closest(const Eigen::Vector3d& p,
                       double reach = std::numeric_limits<double>::infinity()) const;

  // Whether any triangle is within `reach` of p: cheaper than Closest, it stops at the first found.
  bool Within(const Eigen::Vector3d& p, double reach) const;

  // The first hit of origin + t * direction with t in [0, reach]; distance is t.
  std::optional<SurfacePoint> FirstHit(
      const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
      double reach = std::numeric_limits<double>::infinity()) const;

  // Whether the segment meets any triangle.
  bool SegmentMeets(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  // Triangles whose bounds meet `box`, ascending.
  void Overlapping(const Eigen::AlignedBox3d& box, std::vector<int>* triangles) const;

  // The unit normal of a triangle, by its index in the mesh; zero for one without area.
  Eigen::Vector3d Normal(int triangle) const { return normals_[triangle]; }

  int size() const { return static_cast<int>(corners_.size() / 3); }

 private:
  struct Node {
    Eigen::Vector3d low, high;
    int first = 0;  // leaf: first entry of order_; inner: index of the right child
    int count = 0;  // leaf: triangles; inner: 0
  };

  void Build();
  // Triangles that may be within the reach, nearer boxes first, until `visit(closest point, squared
  // distance, triangle)` says no. The visitor may shorten the reach.
  template <typename Visit>
  void VisitNear(const Eigen::Vector3d& p, const double& reach_squared, Visit visit) const;
  // Bounds of some triangles into `node`; returns the extent of their centres.
  Eigen::Vector3d Enclose(const std::vector<Eigen::Vector3d>& source,
                          const std::vector<Eigen::Vector3d>& centers, int first, int count,
                          Node* node) const;

  std::vector<Eigen::Vector3d> corners_;  // (3M x 3), in tree order
  std::vector<int> order_;                // (M) tree order to the mesh's index
  std::vector<Eigen::Vector3d> normals_;  // (M x 3), in the mesh's order
  std::vector<Node> nodes_;               // depth first: the left child follows its parent
};

}  // namespace simwright::geometry
