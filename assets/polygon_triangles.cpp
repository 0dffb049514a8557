#include "assets/polygon_triangles.h"

#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

namespace simwright::assets {
namespace {

constexpr size_t kMostCorners = 2000;  // ear clipping tests each against all others

std::vector<Eigen::Vector2d> Flattened(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  }
  if (!(normal.norm() > 0.0)) return {};
  normal.normalize();
  const Eigen::Vector3d x = normal.unitOrthogonal();
  const Eigen::Vector3d y = normal.cross(x);
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& corner : corners) {
    flat.emplace_back(x.dot(corner - corners[0]), y.dot(corner - corners[0]));
  }
  return flat;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Returns true if the middle of three corners can be clipped: it is convex and no other corner lies
// inside.
bool IsEar(const std::vector<Eigen::Vector2d>& flat, const std::vector<int>& left, size_t at) {
  const size_t n = left.size();
  const int ids[3] = {left[(at + n - 1) % n], left[at], left[(at + 1) % n]};
  const Eigen::Vector2d &a = flat[static_cast<size_t>(ids[0])],
                        &b = flat[static_cast<size_t>(ids[1])],
                        &c = flat[static_cast<size_t>(ids[2])];
  if (!(Cross(a, b, c) > 0.0)) return false;
  for (const int other : left) {
    if (other == ids[0] || other == ids[1] || other == ids[2]) continue;
    const Eigen::Vector2d& p = flat[static_cast<size_t>(other)];
    if (p == a || p == b || p == c) continue;  // a slit's corner occurs twice
    if (Cross(a, b, p) >= 0.0 && Cross(b, c, p) >= 0.0 && Cross(c, a, p) >= 0.0) return false;
  }
  return true;
}

void AddFan(const std::vector<int>& left, std::vector<Eigen::Vector3i>* triangles) {
  for (size_t i = 1; i + 1 < left.size(); ++i) {
    triangles->emplace_back(left[0], left[i], left[i + 1]);
  }
}

}  // namespace

std::vector<Eigen::Vector3i> PolygonTriangles(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> left(corners.size());
  std::iota(left.begin(), left.end(), 0);
  const bool clip = corners.size() > 3 && corners.size() <= kMostCorners;
  std::vector<Eigen::Vector2d> flat;
  if (clip) flat = Flattened(corners);
  while (!flat.empty() && left.size() > 3) {
    size_t ear = 0;
    while (ear < left.size() && !IsEar(flat, left, ear)) ++ear;
    if (ear == left.size()) break;
    const size_t n = left.size();
    triangles.emplace_back(left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  AddFan(left, &triangles);
  return triangles;
}

}  // namespace simwright::assets
