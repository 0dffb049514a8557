#include "geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/error.h"
#include "geometry/exact_hull.h"
#include "geometry/quickhull.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kOnFace = 1e-7;  // of the diagonal; stated in the header
constexpr double kFlat = 1e-6;    // of the diagonal; stated in the header
constexpr int kMostLeftOut = 40;  // per tolerance
// For this many points the exact hull is faster than repairing a rounded one.
constexpr std::size_t kMany = 1000;

double DiagonalOf(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) {
    if (!p.allFinite()) {
      throw core::Error("a point is not finite", "convex hull", "remove NaN and infinite points");
    }
    box.extend(p);
  }
  return points.empty() ? 0.0 : box.diagonal().norm();
}

// Returns the principal directions of the points, thinnest first (columns), right-handed.
Eigen::Matrix3d HullDirections(const std::vector<Vector3d>& points) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : points) middle += p;
  middle /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - middle) * (p - middle).transpose();
  const double scale = spread.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d directions =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread / scale).eigenvectors();
  if (directions.determinant() < 0.0) directions.col(0) *= -1.0;  // no mirror image
  return directions;
}

std::optional<core::TriangleMesh> TryHullAsIs(std::vector<Vector3d> points, double diagonal,
                                              int max_vertices) {
  // A nearly degenerate set is repaired by removing points that are almost collinear with two
  // others or, if that fails, by a larger on-face tolerance.
  const int most_left_out = points.size() > kMany ? 1 : kMostLeftOut;
  for (const double tolerance : {kOnFace, 1e-6, 1e-5, 1e-4, 1e-3}) {
    if (tolerance > 1e-6 && points.size() > kMany) break;
    for (int left_out = 0; left_out < most_left_out && points.size() >= 4; ++left_out) {
      Quickhull hull(points, diagonal, tolerance * diagonal);
      if (!hull.Start()) return std::nullopt;
      hull.Grow(max_vertices);
      int needle = -1;
      const Quickhull::Verdict verdict = hull.Judge(&needle);
      if (verdict == Quickhull::Verdict::kSound) return hull.Take();
      if (verdict == Quickhull::Verdict::kFolded) break;
      points.erase(points.begin() + needle);
    }
  }
  return std::nullopt;
}

// Returns nothing if the points are flat.
std::optional<core::TriangleMesh> TryHull(const std::vector<Vector3d>& points, double diagonal,
                                          int max_vertices) {
  if (auto hull = TryHullAsIs(points, diagonal, max_vertices)) return hull;
  // An affine map of a hull is a hull, and noise on a thin sheet is harmless after stretching.
  const Eigen::Matrix3d frame = HullDirections(points);
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(Vector3d(frame.transpose() * p));
  if (!(box.sizes().minCoeff() > kFlat * diagonal)) return std::nullopt;
  std::vector<Vector3d> stretched;
  for (const Vector3d& p : points) {
    stretched.push_back((frame.transpose() * p - box.center()).cwiseQuotient(box.sizes()));
  }
  if (auto hull = TryHullAsIs(std::move(stretched), std::sqrt(3.0), max_vertices)) {
    for (Vector3d& v : hull->vertices) {
      v = frame * (v.cwiseProduct(box.sizes()) + box.center());
    }
    return hull;
  }
  // Planes in rounded arithmetic cannot resolve thousands of points on nearly flat faces.
  core::TriangleMesh exact = ExactHull(points, max_vertices);
  if (exact.empty()) return std::nullopt;
  return exact;
}

void RequireLimit(int max_vertices) {
  if (max_vertices < 0 || (max_vertices > 0 && max_vertices < 4)) {
    throw core::Error("a hull has at least 4 vertices", "convex hull",
                      "ask for 0 (all), 4 or more");
  }
}

}  // namespace

core::TriangleMesh ConvexHull(const std::vector<Vector3d>& points, int max_vertices) {
  RequireLimit(max_vertices);
  const double diagonal = DiagonalOf(points);
  if (points.size() < 4) {
    throw core::Error("fewer than 4 points enclose no volume", "convex hull");
  }
  std::optional<core::TriangleMesh> hull;
  if (diagonal > 0.0) hull = TryHull(points, diagonal, max_vertices);
  if (!hull) {
    throw core::Error("the points are flat", "convex hull", "thicken them first");
  }
  return *std::move(hull);
}

core::TriangleMesh ThickenedConvexHull(const std::vector<Vector3d>& points, double min_thickness,
                                       int max_vertices) {
  RequireLimit(max_vertices);
  const double diagonal = DiagonalOf(points);
  if (points.empty()) throw core::Error("there are no points", "convex hull");
  if (!(min_thickness > 0.0) || !std::isfinite(min_thickness)) {
    throw core::Error("the minimum thickness is not positive", "convex hull");
  }
  const Eigen::Matrix3d directions = HullDirections(points);
  std::vector<Vector3d> grown = points;
  bool thickened = false;
  for (int k = 0; k < 3; ++k) {
    const Vector3d direction = directions.col(k);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& p : grown) {
      low = std::min(low, direction.dot(p));
      high = std::max(high, direction.dot(p));
    }
    if (high - low >= min_thickness) continue;
    thickened = true;
    // Give both sides the outline of the whole set: a slab, not a ridge.
    std::vector<Vector3d> slab;
    for (const Vector3d& p : grown) {
      const Vector3d flat = p - direction * (direction.dot(p) - 0.5 * (low + high));
      slab.push_back(flat - 0.5 * min_thickness * direction);
      slab.push_back(flat + 0.5 * min_thickness * direction);
    }
    grown = std::move(slab);
  }
  if (grown.size() >= 4) {
    const double size = thickened ? DiagonalOf(grown) : diagonal;
    if (auto hull = TryHull(grown, size, max_vertices)) return *std::move(hull);
  }
  // The remaining case is a set whose thickness vanishes against its length: use its OBB.
  Vector3d low = directions.transpose() * points[0], high = low;
  for (const Vector3d& p : points) {
    low = low.cwiseMin(directions.transpose() * p);
    high = high.cwiseMax(directions.transpose() * p);
  }
  const Vector3d pad =
      0.5 * (Vector3d::Constant(std::max(min_thickness, 4 * kFlat * diagonal)) - (high - low))
                .cwiseMax(0.0);
  std::vector<Vector3d> box;
  for (int c = 0; c < 8; ++c) {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = (c >> k & 1) ? high[k] + pad[k] : low[k] - pad[k];
    box.push_back(directions * p);
  }
  return ConvexHull(box, max_vertices > 0 ? std::max(max_vertices, 8) : 0);
}

}  // namespace simwright::geometry
