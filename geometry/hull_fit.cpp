#include "geometry/hull_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kVolumeWeight = 0.3;    // k of CoACD
constexpr int kFewHullPoints = 60;       // in a first pass
constexpr int kHullPoints = 500;         // per hull: a spacing of about 5% of its size
constexpr double kConcavityStep = 1e-5;  // concavities are multiples of it
constexpr double kWorthSampling = 1e-3;  // concavity above which an excess is sampled
constexpr int kOutsideBlocks = 32;
constexpr int kOutsideSamples = 8192;  // points in the AABB that measure a volume

// Returns a direction that no axis-aligned or regularly rotated face is parallel to.
const Vector3d& SkewDirection() {
  static const Vector3d direction = Vector3d(0.5377, 0.2893, 0.7920).normalized();
  return direction;
}

// Returns the point `i` of a sequence of low discrepancy in the unit cube: M. Roberts' additive
// recurrence, whose steps are powers of the root of x^4 = x + 1.
Vector3d EvenPoint(int i) {
  constexpr double kRoot = 1.2207440846057596;
  const Vector3d step(1.0 / kRoot, 1.0 / (kRoot * kRoot), 1.0 / (kRoot * kRoot * kRoot));
  const Vector3d p = Vector3d::Constant(0.5) + (i + 1) * step;
  return p.array() - p.array().floor();
}

// Calls visit(p) for points spread evenly over each triangle, by area, at least at its centroid;
// stops when it returns false.
template <typename Visit>
void VisitSurface(const core::TriangleMesh& mesh, int count, Visit visit) {
  const double spacing = std::sqrt(core::SurfaceArea(mesh) / count);
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]];
    const Vector3d ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
    const double area = 0.5 * ab.cross(ac).norm();
    // Centroids of the n^2 similar triangles; a needle gets as many as its length requires.
    const double length = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int by_area = static_cast<int>(std::ceil(std::sqrt(area) / spacing));
    const int by_length = static_cast<int>(std::ceil(0.25 * length / spacing));
    const int n = std::clamp(std::max(by_area, by_length), 1, 32);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        if (!visit(a + (i + 1.0 / 3.0) / n * ab + (j + 1.0 / 3.0) / n * ac)) return;
        if (i + j + 1 >= n) continue;
        if (!visit(a + (i + 2.0 / 3.0) / n * ab + (j + 2.0 / 3.0) / n * ac)) return;
      }
    }
  }
}

}  // namespace

std::vector<Vector4d> FacePlanes(const core::TriangleMesh& hull) {
  std::vector<Vector4d> planes;
  planes.reserve(hull.triangles.size());
  const PointLanes vertices(hull.vertices);
  for (int t = 0; t < static_cast<int>(hull.triangles.size()); ++t) {
    const Vector3d normal = core::TriangleAreaVector(hull, t).normalized();
    // A thin triangle's normal may be inaccurate; a plane that supports all vertices is still
    // correct.
    planes.emplace_back(normal.x(), normal.y(), normal.z(), vertices.Support(normal));
  }
  return planes;
}

double MaxPlaneDistance(const std::vector<Vector4d>& planes, const Vector3d& p) {
  double height = -std::numeric_limits<double>::infinity();
  for (const Vector4d& plane : planes) {
    height = std::max(height, plane.head<3>().dot(p) - plane[3]);
  }
  return height;
}

bool InsideSurface(const core::TriangleMesh& mesh, const TriangleTree& tree, const Vector3d& p) {
  const auto hit = tree.FirstHit(p, SkewDirection());
  return hit && core::TriangleAreaVector(mesh, hit->triangle).dot(SkewDirection()) > 0.0;
}

HullDeviation::HullDeviation(const core::TriangleMesh& solid, int samples, std::uint64_t seed)
    : solid_(solid),
      tree_(solid),
      samples_(SampleSurface(solid, samples, seed)),
      sample_lanes_(samples_),
      unit_(0.5 * core::Bounds(solid).sizes().maxCoeff()) {
  const Eigen::AlignedBox3d box = core::Bounds(solid_);
  sample_volume_ = box.volume() / kOutsideSamples;
  std::vector<Vector3d> points(kOutsideSamples);
  std::vector<char> outside(kOutsideSamples, 0);
  core::ParallelFor(kOutsideBlocks, [&](int block) {
    for (int i = block; i < kOutsideSamples; i += kOutsideBlocks) {
      points[i] = box.min() + EvenPoint(i).cwiseProduct(box.sizes());
      outside[i] = Outside(points[i]);
    }
  });
  std::vector<Vector3d> kept;
  for (int i = 0; i < kOutsideSamples; ++i) {
    if (outside[i]) kept.push_back(points[i]);
  }
  outside_ = PointLanes(kept);
}

double HullDeviation::OutsideVolume(const core::TriangleMesh& hull,
                                    const std::vector<Vector4d>& planes) const {
  return outside_.Within(core::Bounds(hull)).CountBelow(planes) * sample_volume_;
}

double HullDeviation::VolumeConcavity(double excess_volume) const {
  const double radius = std::cbrt(3.0 * std::max(0.0, excess_volume) / (4.0 * std::numbers::pi));
  return kVolumeWeight * radius / unit_;
}

bool HullDeviation::Outside(const Vector3d& p) const {
  return !InsideSurface(solid_, tree_, p);
}

double HullDeviation::Overhang(const core::TriangleMesh& hull, int points, double least,
                               double enough) const {
  double farthest = least;
  int home = -1;
  VisitSurface(hull, points, [&](const Vector3d& p) {
    // Most points are nearer than the farthest so far, which is cheaper to test than their
    // distance.
    if (!tree_.Within(p, farthest, &home) && Outside(p)) {
      farthest = std::max(farthest, tree_.Closest(p).distance);
    }
    return farthest <= enough;
  });
  return farthest;
}

double HullDeviation::Buried(const core::TriangleMesh& hull, const std::vector<Vector4d>& planes,
                             double enough) const {
  return sample_lanes_.Within(core::Bounds(hull)).Depth(planes, enough);
}

double HullDeviation::Distance(const core::TriangleMesh& hull) const {
  const double all = std::numeric_limits<double>::infinity();
  return Overhang(hull, kHullPoints, Buried(hull, FacePlanes(hull), all), all);
}

double HullDeviation::Concavity(const core::TriangleMesh& hull, double volume,
                                double enough) const {
  const double measured = Measure(hull, volume, enough);
  const double rounded = kConcavityStep * std::round(measured / kConcavityStep);
  // A bound above `enough` stays above it.
  return measured > enough && rounded <= enough ? rounded + 2.0 * kConcavityStep : rounded;
}

double HullDeviation::Measure(const core::TriangleMesh& hull, double volume, double enough) const {
  const std::vector<Vector4d> planes = FacePlanes(hull);
  double concavity = Buried(hull, planes, enough * unit_) / unit_;
  // Few points show most of the hulls that are too concave.
  for (const int points : {kFewHullPoints, kHullPoints}) {
    if (concavity > enough) return concavity;
    // Points that are nearer to the solid than this do not change the rounded concavity.
    const double least = std::max(concavity, std::min(0.1 * kConcavityStep, 0.5 * enough)) * unit_;
    const double farthest = Overhang(hull, points, least, enough * unit_);
    if (farthest > least) concavity = std::max(concavity, farthest / unit_);
  }
  if (concavity > enough) return concavity;
  const double excess = SignedVolume(hull) - volume;
  if (VolumeConcavity(excess) <= std::max(concavity, kWorthSampling)) {
    return std::max(concavity, VolumeConcavity(excess));
  }
  return std::max(concavity, VolumeConcavity(std::min(excess, OutsideVolume(hull, planes))));
}

}  // namespace simwright::geometry
