#include "geometry/surface_fairness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

void RequireValidFairness(const SurfaceFairnessOptions& options) {
  if (options.rays < 100) throw core::Error("rays must be at least 100", "surface fairness");
  if (!(options.radius > 0.0 && options.radius < 0.5)) {
    throw core::Error("radius must be in (0, 0.5)", "surface fairness");
  }
}

// The hits of one cell are consecutive.
class HitGrid {
 public:
  HitGrid(const std::vector<OuterHit>& hits, double cell) : cell_(cell) {
    for (int i = 0; i < static_cast<int>(hits.size()); ++i) {
      cells_[Key(Cell(hits[i].point))].push_back(i);
    }
  }

  // Calls `visit(index)` for each hit in the cells around a point.
  template <typename Visit>
  void Near(const Eigen::Vector3d& point, Visit visit) const {
    const Eigen::Vector3i middle = Cell(point);
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells_.find(Key(middle + Eigen::Vector3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found == cells_.end()) continue;
      for (const int i : found->second) visit(i);
    }
  }

 private:
  Eigen::Vector3i Cell(const Eigen::Vector3d& point) const {
    return (point / cell_).array().floor().cast<int>();
  }
  static std::int64_t Key(const Eigen::Vector3i& cell) {
    return (std::int64_t{cell.x()} * 2097152 + cell.y()) * 2097152 + cell.z();
  }

  double cell_;
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

struct SampledSurface {
  std::vector<OuterHit> hits;
  double diagonal = 0.0;  // m
};

SampledSurface Sampled(const core::TriangleMesh& mesh, const SurfaceFairnessOptions& options) {
  RequireValidFairness(options);
  SampledSurface sampled{SampleOuterHits(mesh, options.rays, options.seed),
                         core::Bounds(mesh).diagonal().norm()};
  if (sampled.hits.size() < 100) {
    throw core::Error("has no outer surface that rays hit", "surface fairness");
  }
  return sampled;
}

// Returns the angle between each hit's normal and the mean normal around it, rad, ascending.
std::vector<double> NormalDeviations(const SampledSurface& surface, double radius) {
  const HitGrid grid(surface.hits, radius);
  std::vector<double> angles(surface.hits.size());
  core::ParallelFor(static_cast<int>(angles.size()), [&](int i) {
    const OuterHit& hit = surface.hits[static_cast<size_t>(i)];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    grid.Near(hit.point, [&](int j) {
      const OuterHit& other = surface.hits[static_cast<size_t>(j)];
      const double distance = (other.point - hit.point).squaredNorm() / (radius * radius);
      // The other side of a thin wall is near, and faces away.
      if (distance > 1.0 || other.normal.dot(hit.normal) < 0.0) return;
      sum += std::exp(-2.0 * distance) * other.normal;
    });
    angles[static_cast<size_t>(i)] = std::atan2(sum.cross(hit.normal).norm(), sum.dot(hit.normal));
  });
  std::sort(angles.begin(), angles.end());
  return angles;
}

constexpr double kFaceAngle = 25.0 * std::numbers::pi / 180.0;  // rad
constexpr double kFaceDepth = 0.1;                              // of the diagonal

// Returns the unused hits whose normals are within the face's angle of `normal`.
std::vector<int> HitsFacing(const std::vector<OuterHit>& hits, const std::vector<char>& used,
                            const Eigen::Vector3d& normal) {
  std::vector<int> facing;
  for (int i = 0; i < static_cast<int>(hits.size()); ++i) {
    if (!used[i] && hits[i].normal.dot(normal) > std::cos(kFaceAngle)) facing.push_back(i);
  }
  return facing;
}

// Returns the direction that most unused hits face: the best of their normals, averaged.
Eigen::Vector3d CommonDirection(const std::vector<OuterHit>& hits, const std::vector<char>& used) {
  Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
  size_t most = 0;
  const size_t step = std::max<size_t>(1, hits.size() / 200);
  for (size_t i = 0; i < hits.size(); i += step) {
    if (used[i]) continue;
    const size_t count = HitsFacing(hits, used, hits[i].normal).size();
    if (count > most) {
      most = count;
      best = hits[i].normal;
    }
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : HitsFacing(hits, used, best)) mean += hits[i].normal;
  return mean.norm() > 0.0 ? mean.normalized() : best;
}

// Keeps of the hits those in the slab of the face's depth that holds the most.
void KeepFullestSlab(const std::vector<OuterHit>& hits, const Eigen::Vector3d& normal, double depth,
                     std::vector<int>* members) {
  std::sort(members->begin(), members->end(), [&](int a, int b) {
    const double at_a = hits[a].point.dot(normal), at_b = hits[b].point.dot(normal);
    return at_a != at_b ? at_a < at_b : a < b;
  });
  size_t best = 0, most = 0, end = 0;
  for (size_t begin = 0; begin < members->size(); ++begin) {
    const double low = hits[(*members)[begin]].point.dot(normal);
    while (end < members->size() && hits[(*members)[end]].point.dot(normal) <= low + depth) ++end;
    if (end - begin > most) {
      most = end - begin;
      best = begin;
    }
  }
  *members = std::vector<int>(members->begin() + static_cast<std::ptrdiff_t>(best),
                              members->begin() + static_cast<std::ptrdiff_t>(best + most));
}

// A plane through points, and the root mean square distance to it.
struct FittedPlane {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double deviation = 0.0;
};

FittedPlane FitPlane(const std::vector<OuterHit>& hits, const std::vector<int>& members) {
  FittedPlane plane;
  for (const int i : members) plane.center += hits[i].point;
  plane.center /= static_cast<double>(members.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int i : members) {
    const Eigen::Vector3d d = hits[i].point - plane.center;
    covariance += d * d.transpose() / static_cast<double>(members.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  plane.normal = solver.eigenvectors().col(0);
  plane.deviation = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  return plane;
}

// Keeps the share of the members that `measure` ranks lowest.
template <typename Measure>
void KeepLowest(double share, Measure measure, std::vector<int>* members) {
  std::vector<std::pair<double, int>> ranked;
  for (const int i : *members) ranked.emplace_back(measure(i), i);
  std::sort(ranked.begin(), ranked.end());
  members->resize(std::max<size_t>(3, static_cast<size_t>(share * ranked.size())));
  for (size_t k = 0; k < members->size(); ++k) (*members)[k] = ranked[k].second;
}

// Fits a plane to the inner part of the members, without handles and other protrusions.
FlatFace FitFace(const std::vector<OuterHit>& hits, std::vector<int> members,
                 const Eigen::Vector3d& toward) {
  constexpr double kInner = 0.9, kWithoutHandles = 0.8;
  FlatFace face;
  face.share = static_cast<double>(members.size()) / static_cast<double>(hits.size());
  const Eigen::Vector3d center = FitPlane(hits, members).center;
  KeepLowest(
      kInner, [&](int i) { return (hits[i].point - center).cross(toward).norm(); }, &members);
  const FittedPlane all = FitPlane(hits, members);
  KeepLowest(
      kWithoutHandles,
      [&](int i) { return std::abs((hits[i].point - all.center).dot(all.normal)); }, &members);
  const FittedPlane plane = FitPlane(hits, members);
  face.normal = plane.normal.dot(toward) < 0.0 ? -plane.normal : plane.normal;
  face.deviation = plane.deviation;
  return face;
}

// Returns the mean distance to the surface of points mirrored in the vertical plane through
// `center` whose normal has the azimuth.
double MirrorDifference(const std::vector<Eigen::Vector3d>& points, const TriangleTree& tree,
                        const Eigen::Vector3d& center, double azimuth) {
  const Eigen::Vector3d normal(std::cos(azimuth), std::sin(azimuth), 0.0);
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) {
    sum += tree.Closest(point - 2.0 * (point - center).dot(normal) * normal).distance;
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace

SurfaceFairness MeasureFairness(const core::TriangleMesh& mesh,
                                const SurfaceFairnessOptions& options) {
  const SampledSurface surface = Sampled(mesh, options);
  const std::vector<double> angles = NormalDeviations(surface, options.radius * surface.diagonal);
  const auto mean = [&](size_t begin, size_t end) {
    return std::accumulate(angles.begin() + static_cast<std::ptrdiff_t>(begin),
                           angles.begin() + static_cast<std::ptrdiff_t>(end), 0.0) /
           static_cast<double>(end - begin);
  };
  const size_t n = angles.size();
  return {mean(0, n), mean(n / 4, n - n / 4)};
}

std::vector<FlatFace> FindFlatFaces(const core::TriangleMesh& mesh, double least_share,
                                    const SurfaceFairnessOptions& options) {
  const SampledSurface surface = Sampled(mesh, options);
  std::vector<char> used(surface.hits.size(), 0);
  std::vector<FlatFace> faces;
  const double least = std::max(8.0, least_share * static_cast<double>(surface.hits.size()));
  while (true) {
    const Eigen::Vector3d normal = CommonDirection(surface.hits, used);
    std::vector<int> members = HitsFacing(surface.hits, used, normal);
    if (static_cast<double>(members.size()) < least) break;
    KeepFullestSlab(surface.hits, normal, kFaceDepth * surface.diagonal, &members);
    for (const int i : members) used[i] = 1;
    if (static_cast<double>(members.size()) < least) continue;
    faces.push_back(FitFace(surface.hits, members, normal));
  }
  std::sort(faces.begin(), faces.end(),
            [](const FlatFace& a, const FlatFace& b) { return a.share > b.share; });
  return faces;
}

MirrorSymmetry FindMirrorSymmetry(const core::TriangleMesh& mesh,
                                  const SurfaceFairnessOptions& options) {
  constexpr int kSteps = 36, kRefinements = 4;
  constexpr size_t kPoints = 1500;
  const SampledSurface surface = Sampled(mesh, options);
  std::vector<Eigen::Vector3d> points;
  const size_t step = std::max<size_t>(1, surface.hits.size() / kPoints);
  for (size_t i = 0; i < surface.hits.size(); i += step) points.push_back(surface.hits[i].point);
  // The middle of what rays hit: one protruding part shifts the middle of the bounds.
  const Eigen::Vector3d center =
      std::accumulate(points.begin(), points.end(), Eigen::Vector3d(0, 0, 0)) /
      static_cast<double>(points.size());
  const TriangleTree tree(mesh);
  std::vector<double> differences(kSteps);
  core::ParallelFor(kSteps, [&](int k) {
    differences[static_cast<size_t>(k)] =
        MirrorDifference(points, tree, center, k * std::numbers::pi / kSteps);
  });
  const auto best = std::min_element(differences.begin(), differences.end());
  MirrorSymmetry symmetry{(best - differences.begin()) * std::numbers::pi / kSteps, *best};
  double width = 0.5 * std::numbers::pi / kSteps;
  for (int k = 0; k < kRefinements; ++k, width *= 0.5) {
    for (const double azimuth : {symmetry.azimuth - width, symmetry.azimuth + width}) {
      const double difference = MirrorDifference(points, tree, center, azimuth);
      if (difference < symmetry.difference) symmetry = {azimuth, difference};
    }
  }
  symmetry.azimuth = std::fmod(symmetry.azimuth + std::numbers::pi, std::numbers::pi);
  return symmetry;
}

}  // namespace simwright::geometry
