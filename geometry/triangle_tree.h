#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lanes.h"
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

// The corners of up to four triangles, by coordinate; NaN for a missing one.
struct TriangleLanes {
  double a[3][core::kLanes], b[3][core::kLanes], c[3][core::kLanes];
};

// Up to four AABBs, by coordinate.
struct BoxLanes {
  double low[3][core::kLanes], high[3][core::kLanes];
};

struct TreeNode {
  BoxLanes boxes;  // of the children, enlarged by the rounding of what is computed inside
  int child[core::kLanes] = {};  // >= 0: a node; otherwise ~child is a leaf
  int count = 0;                 // children
};

struct TreeLeaf {
  TriangleLanes triangles;
  int index[core::kLanes];  // of the triangles in the mesh, or -1
};

// A bounding volume hierarchy over the triangles of one mesh, for closest points, first hits and
// overlap: four boxes to a node and up to four triangles to a leaf, each tested at once. Queries
// are const and thread-safe.
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

  // The same for points that follow each other closely: `home` (-1 at first) keeps the leaf of
  // this tree that was within reach of the last one, which is tested first.
  bool Within(const Eigen::Vector3d& p, double reach, int* home) const;

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

  int size() const { return static_cast<int>(normals_.size()); }

 private:
  void Build(const core::TriangleMesh& mesh);

  std::vector<Eigen::Vector3d> normals_;  // (M x 3)
  std::vector<TreeNode> nodes_;           // the root is the first
  std::vector<TreeLeaf> leaves_;
};

}  // namespace simwright::geometry
