#include "geometry/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point ToPoint(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

using TriangleCorners = std::array<Point, 3>;

TriangleCorners CornersOf(const core::TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  return {ToPoint(mesh.vertices[t[0]]), ToPoint(mesh.vertices[t[1]]), ToPoint(mesh.vertices[t[2]])};
}

// Returns true if all of `points` lie strictly on one side of the plane of `t`.
template <std::size_t N>
bool OnOneSide(const TriangleCorners& t, const std::array<Point, N>& points) {
  const CGAL::Orientation first = CGAL::orientation(t[0], t[1], t[2], points[0]);
  if (first == CGAL::COPLANAR) return false;
  for (std::size_t i = 1; i < N; ++i) {
    if (CGAL::orientation(t[0], t[1], t[2], points[i]) != first) return false;
  }
  return true;
}

bool MeetBesidesShared(const core::TriangleMesh& mesh, int ta, int tb) {
  const Eigen::Vector3i& a = mesh.triangles[ta];
  const Eigen::Vector3i& b = mesh.triangles[tb];
  int shared = 0;
  std::array<int, 3> at_a{}, at_b{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a[i] == b[j] && shared < 3) {
        at_a[shared] = i;
        at_b[shared] = j;
        ++shared;
      }
    }
  }
  if (shared == 3) return true;
  const TriangleCorners pa = CornersOf(mesh, ta);
  const TriangleCorners pb = CornersOf(mesh, tb);
  if (shared == 2) {
    const Point& p = pa[at_a[0]];
    const Point& q = pa[at_a[1]];
    const Point& r = pa[3 - at_a[0] - at_a[1]];
    const Point& s = pb[3 - at_b[0] - at_b[1]];
    return CGAL::orientation(p, q, r, s) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }
  if (shared == 1) {
    const std::array<Point, 2> ea = {pa[(at_a[0] + 1) % 3], pa[(at_a[0] + 2) % 3]};
    const std::array<Point, 2> eb = {pb[(at_b[0] + 1) % 3], pb[(at_b[0] + 2) % 3]};
    if (OnOneSide(pa, eb) || OnOneSide(pb, ea)) return false;
    return CGAL::do_intersect(Kernel::Triangle_3(pa[0], pa[1], pa[2]),
                              Kernel::Segment_3(eb[0], eb[1])) ||
           CGAL::do_intersect(Kernel::Triangle_3(pb[0], pb[1], pb[2]),
                              Kernel::Segment_3(ea[0], ea[1]));
  }
  if (OnOneSide(pa, pb) || OnOneSide(pb, pa)) return false;
  return CGAL::do_intersect(Kernel::Triangle_3(pa[0], pa[1], pa[2]),
                            Kernel::Triangle_3(pb[0], pb[1], pb[2]));
}

}  // namespace

bool IsDegenerate(const core::TriangleMesh& mesh, int triangle) {
  const TriangleCorners p = CornersOf(mesh, triangle);
  return CGAL::collinear(p[0], p[1], p[2]);
}

std::vector<std::pair<int, int>> SelfIntersections(const core::TriangleMesh& mesh, int limit) {
  const TriangleTree tree(mesh);
  const int count = static_cast<int>(mesh.triangles.size());
  std::vector<char> degenerate(count);
  for (int t = 0; t < count; ++t) degenerate[t] = IsDegenerate(mesh, t);
  constexpr int kBlock = 512;
  const int blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::vector<std::pair<int, int>>> found(blocks);
  core::ParallelFor(blocks, [&](int block) {
    core::CheckCancelled();
    std::vector<int> candidates;
    auto& pairs = found[block];
    for (int t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
      if (degenerate[t]) continue;
      Eigen::AlignedBox3d box;
      for (int c = 0; c < 3; ++c) box.extend(mesh.vertices[mesh.triangles[t][c]]);
      tree.Overlapping(box, &candidates);
      for (const int other : candidates) {
        if (static_cast<int>(pairs.size()) >= limit) return;
        if (other <= t || degenerate[other]) continue;
        if (MeetBesidesShared(mesh, t, other)) pairs.emplace_back(t, other);
      }
    }
  });
  std::vector<std::pair<int, int>> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  if (static_cast<int>(all.size()) > limit) all.resize(std::max(limit, 0));
  return all;
}

}  // namespace simwright::geometry
