#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// The result of a query.
struct SurfacePoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = std::numeric_limits<double>::infinity();  // m; for a ray: from its origin
  int triangle = -1;
};

// Returns the point of triangle abc closest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

// A bounding volume hierarchy over the triangles of one mesh, for closest points, first hits and
// overlap. Queries are const and thread-safe.
class TriangleTree {
 public:
  // Keeps a copy of the corners. Throws core::Error on an index out of range or NaN.
  explicit TriangleTree(const core::TriangleMesh& mesh);

  // Returns the closest point within `reach`; triangle -1 if there is none. Ties: the lowest
  // triangle.
  SurfacePoint Closest(const Eigen::Vector3d& p,
                       double reach = std::numeric_limits<double>::infinity()) const;

  // Returns true if any triangle is within `reach` of p. Cheaper than Closest: it stops at the
  // first.
  bool Within(const Eigen::Vector3d& p, double reach) const;

  // Returns the first hit of origin + t * direction with t in [0, reach]; distance is t.
  std::optional<SurfacePoint> FirstHit(
      const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
      double reach = std::numeric_limits<double>::infinity()) const;

  // Returns true if the segment meets any triangle.
  bool SegmentMeets(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  // Collects the triangles whose AABBs overlap `box`, ascending.
  void Overlapping(const Eigen::AlignedBox3d& box, std::vector<int>* triangles) const;

  // Returns the unit normal of a triangle, by its index in the mesh; zero for one without area.
  Eigen::Vector3d Normal(int triangle) const { return normals_[triangle]; }

  int size() const { return static_cast<int>(corners_.size() / 3); }

 private:
  struct Node {
    Eigen::Vector3d low, high;
    int first = 0;  // leaf: first entry of order_; inner: index of the right child
    int count = 0;  // leaf: triangles; inner: 0
  };

  void Build();
  // Visits triangles that may be within reach, nearer AABBs first, until `visit(closest point,
  // squared distance, triangle)` returns false. The visitor may shorten the reach.
  template <typename Visit>
  void VisitNear(const Eigen::Vector3d& p, const double& reach_squared, Visit visit) const;
  // Sets the bounds of `node` to those of some triangles; returns the extent of their centres.
  Eigen::Vector3d Enclose(const std::vector<Eigen::Vector3d>& source,
                          const std::vector<Eigen::Vector3d>& centers, int first, int count,
                          Node* node) const;

  std::vector<Eigen::Vector3d> corners_;  // (3M x 3), in tree order
  std::vector<int> order_;                // (M) tree order to the mesh's index
  std::vector<Eigen::Vector3d> normals_;  // (M x 3), in the mesh's order
  std::vector<Node> nodes_;               // depth first: the left child follows its parent
};

}  // namespace simwright::geometry
