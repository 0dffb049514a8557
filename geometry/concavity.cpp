#include "geometry/concavity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/hull_fit.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kConcavityBlock = 1024;  // samples per task, independent of the thread count

void RequireMesh(const core::TriangleMesh& mesh, const char* where) {
  core::RequireValid(mesh, where);
  if (mesh.empty()) throw core::Error("the mesh has no triangles", where);
}

// Convex parts with point-containment queries.
class PartSet {
 public:
  explicit PartSet(const std::vector<core::TriangleMesh>& parts) {
    for (const core::TriangleMesh& part : parts) {
      planes_.push_back(FacePlanes(part));
      boxes_.push_back(core::Bounds(part));
    }
  }

  // Returns true if some part other than `except` contains `p` deeper than `depth` (m, may be
  // negative).
  bool Contains(const Vector3d& p, double depth, int except) const {
    for (int i = 0; i < static_cast<int>(planes_.size()); ++i) {
      if (i == except || boxes_[i].exteriorDistance(p) > std::max(0.0, -depth)) continue;
      if (MaxPlaneDistance(planes_[i], p) < -depth) return true;
    }
    return false;
  }

  // Returns the distance from `p` inside the union to its surface if it is less than `best`: along
  // a face normal of a part that contains `p`, to a point that no other part contains.
  double ExitDistance(const Vector3d& p, double step, double best) const {
    for (int i = 0; i < static_cast<int>(planes_.size()); ++i) {
      if (!boxes_[i].contains(p) || MaxPlaneDistance(planes_[i], p) > 0.0) continue;
      for (const Vector4d& plane : planes_[i]) {
        const double depth = plane[3] - plane.head<3>().dot(p);
        if (depth >= best) continue;
        const Vector3d end = p + (depth + step) * plane.head<3>();
        if (MaxPlaneDistance(planes_[i], end) <= 2.0 * step && !Contains(end, 0.0, i)) best = depth;
      }
    }
    return best;
  }

 private:
  std::vector<std::vector<Vector4d>> planes_;
  std::vector<Eigen::AlignedBox3d> boxes_;
};

// Finds the nearest of a fixed set of points: a bucket grid, searched ring by ring.
class SampleGrid {
 public:
  explicit SampleGrid(std::vector<Vector3d> points) : points_(std::move(points)) {
    for (const Vector3d& p : points_) box_.extend(p);
    const double longest = std::max(box_.sizes().maxCoeff(), 1e-300);
    cell_ = longest / std::max(1.0, std::sqrt(static_cast<double>(points_.size()) / 6.0));
    for (int k = 0; k < 3; ++k) {
      counts_[k] = std::clamp(static_cast<int>(box_.sizes()[k] / cell_) + 1, 1, 200);
    }
    cell_ = std::max(cell_, longest / 199.0);
    buckets_.resize(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2]);
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const Eigen::Vector3i c = CellOf(points_[i]);
      buckets_[Index(c[0], c[1], c[2])].push_back(i);
    }
  }

  double Distance(const Vector3d& p) const {
    const Eigen::Vector3i home = CellOf(p);
    const int rings = *std::max_element(counts_, counts_ + 3);
    double best = std::numeric_limits<double>::infinity();
    const double outside = box_.exteriorDistance(p);
    for (int ring = 0; ring <= rings; ++ring) {
      if (best <= std::max(outside, (ring - 1) * cell_)) break;
      VisitRing(home, ring, [&](int i) { best = std::min(best, (points_[i] - p).norm()); });
    }
    return best;
  }

 private:
  Eigen::Vector3i CellOf(const Vector3d& p) const {
    Eigen::Vector3i c;
    for (int k = 0; k < 3; ++k) {
      const double at = std::floor((p[k] - box_.min()[k]) / cell_);
      c[k] = static_cast<int>(std::clamp(at, 0.0, counts_[k] - 1.0));
    }
    return c;
  }

  std::size_t Index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * counts_[1] + y) * counts_[0] + x;
  }

  template <typename Visit>
  void VisitRing(const Eigen::Vector3i& home, int ring, Visit visit) const {
    for (int z = std::max(0, home[2] - ring); z <= std::min(counts_[2] - 1, home[2] + ring); ++z) {
      for (int y = std::max(0, home[1] - ring); y <= std::min(counts_[1] - 1, home[1] + ring);
           ++y) {
        const bool face = std::abs(z - home[2]) == ring || std::abs(y - home[1]) == ring;
        const int step = face || ring == 0 ? 1 : 2 * ring;
        for (int x = home[0] - ring; x <= home[0] + ring; x += step) {
          if (x < 0 || x >= counts_[0]) continue;
          for (const int i : buckets_[Index(x, y, z)]) visit(i);
        }
      }
    }
  }

  std::vector<Vector3d> points_;
  Eigen::AlignedBox3d box_;
  double cell_ = 1.0;
  int counts_[3] = {1, 1, 1};
  std::vector<std::vector<int>> buckets_;
};

// Samples points on the parts' surfaces that no other part contains.
std::vector<Vector3d> SampleUnion(const std::vector<core::TriangleMesh>& parts, const PartSet& set,
                                  double diagonal, const ConcavityOptions& options) {
  double area = 0.0;
  for (const core::TriangleMesh& part : parts) area += core::SurfaceArea(part);
  std::vector<std::vector<Vector3d>> kept(parts.size());
  core::ParallelFor(static_cast<int>(parts.size()), [&](int i) {
    const double share = core::SurfaceArea(parts[i]) / area;
    const int count = std::max(50, static_cast<int>(options.surface_samples * share));
    const std::vector<Vector4d> planes = FacePlanes(parts[i]);
    for (const Vector3d& p : SampleSurface(parts[i], count, options.seed + 17 * (i + 1))) {
      const auto face =
          std::max_element(planes.begin(), planes.end(), [&](const auto& a, const auto& b) {
            return a.template head<3>().dot(p) - a[3] < b.template head<3>().dot(p) - b[3];
          });
      // A step outward distinguishes a face shared back to back (inside the union) from two
      // coincident faces on the union's surface; cracks thinner than the step are ignored.
      const Vector3d outward = p + options.coverage_tolerance * diagonal * face->head<3>();
      if (!set.Contains(outward, 0.0, i)) kept[i].push_back(p);
    }
  });
  std::vector<Vector3d> all;
  for (const auto& points : kept) all.insert(all.end(), points.begin(), points.end());
  return all;
}

void MeasureVolumes(const core::TriangleMesh& solid, const TriangleTree& tree, const PartSet& set,
                    const std::vector<core::TriangleMesh>& parts, const ConcavityOptions& options,
                    DecompositionQuality* quality) {
  Eigen::AlignedBox3d box = core::Bounds(solid);
  for (const core::TriangleMesh& part : parts) box.extend(core::Bounds(part));
  const int blocks = (options.volume_samples + kConcavityBlock - 1) / kConcavityBlock;
  std::vector<std::array<int, 3>> counts(blocks, {0, 0, 0});  // in the solid, excess, missing
  core::ParallelFor(blocks, [&](int b) {
    core::Rng rng = core::StreamRng(options.seed, 1000 + b);
    const int end = std::min(options.volume_samples, (b + 1) * kConcavityBlock);
    for (int i = b * kConcavityBlock; i < end; ++i) {
      Vector3d p;
      for (int k = 0; k < 3; ++k) p[k] = core::Uniform(rng, box.min()[k], box.max()[k]);
      const bool in_solid = InsideSurface(solid, tree, p);
      const bool in_parts = set.Contains(p, 0.0, -1);
      counts[b][0] += in_solid;
      counts[b][1] += in_parts && !in_solid;
      counts[b][2] += in_solid && !in_parts;
    }
  });
  double excess = 0.0, missing = 0.0;
  for (const auto& c : counts) {
    excess += c[1];
    missing += c[2];
  }
  // Relative to the exact volume: the count inside a thin solid is noisy.
  const double volume = std::max(std::abs(SignedVolume(solid)), 1e-300);
  const double each = box.volume() / options.volume_samples / volume;
  quality->excess_volume = excess * each;
  quality->missing_volume = missing * each;
  quality->volume_error = (excess + missing) * each;
}

double CoveredShare(const std::vector<Vector3d>& points, const PartSet& set, double tolerance) {
  const int n = static_cast<int>(points.size());
  const int blocks = (n + kConcavityBlock - 1) / kConcavityBlock;
  std::vector<int> covered(blocks, 0);
  core::ParallelFor(blocks, [&](int b) {
    for (int i = b * kConcavityBlock; i < std::min(n, (b + 1) * kConcavityBlock); ++i) {
      covered[b] += set.Contains(points[i], -tolerance, -1);
    }
  });
  return std::accumulate(covered.begin(), covered.end(), 0.0) / std::max(1, n);
}

void RequireParts(const core::TriangleMesh& solid, const std::vector<core::TriangleMesh>& parts,
                  const ConcavityOptions& options) {
  RequireMesh(solid, "decomposition quality");
  if (parts.empty()) throw core::Error("there are no parts", "decomposition quality");
  for (const core::TriangleMesh& part : parts) RequireMesh(part, "decomposition quality");
  if (options.surface_samples < 1 || options.volume_samples < 1) {
    throw core::Error("the number of samples is not positive", "decomposition quality");
  }
}

}  // namespace

DecompositionQuality MeasureDecomposition(const core::TriangleMesh& solid,
                                          const std::vector<core::TriangleMesh>& parts,
                                          const ConcavityOptions& options) {
  RequireParts(solid, parts, options);
  const double diagonal = core::Bounds(solid).diagonal().norm();
  const TriangleTree tree(solid);
  const PartSet set(parts);
  const std::vector<Vector3d> on_solid =
      SampleSurface(solid, options.surface_samples, options.seed);
  const std::vector<Vector3d> on_parts = SampleUnion(parts, set, diagonal, options);
  const SampleGrid grid(on_parts);
  core::TriangleMesh all_parts;
  for (const core::TriangleMesh& part : parts) core::Append(part, &all_parts);
  const TriangleTree parts_tree(all_parts);

  DecompositionQuality quality;
  std::vector<double> to_parts(on_solid.size()), outside(on_solid.size(), 0.0);
  std::vector<double> to_solid(on_parts.size());
  core::ParallelFor(
      static_cast<int>(on_solid.size() + kConcavityBlock - 1) / kConcavityBlock, [&](int b) {
        const std::size_t end =
            std::min(on_solid.size(), static_cast<std::size_t>(b + 1) * kConcavityBlock);
        for (std::size_t i = static_cast<std::size_t>(b) * kConcavityBlock; i < end; ++i) {
          const Vector3d& p = on_solid[i];
          if (set.Contains(p, 0.0, -1)) {
            to_parts[i] =
                set.ExitDistance(p, options.coverage_tolerance * diagonal, grid.Distance(p));
          } else {
            to_parts[i] = outside[i] = parts_tree.Closest(p).distance;
          }
        }
      });
  core::ParallelFor(
      static_cast<int>(on_parts.size() + kConcavityBlock - 1) / kConcavityBlock, [&](int b) {
        const std::size_t end =
            std::min(on_parts.size(), static_cast<std::size_t>(b + 1) * kConcavityBlock);
        for (std::size_t i = static_cast<std::size_t>(b) * kConcavityBlock; i < end; ++i) {
          to_solid[i] = tree.Closest(on_parts[i]).distance;
        }
      });
  quality.uncovered = *std::max_element(outside.begin(), outside.end()) / diagonal;
  if (!on_parts.empty()) {
    quality.solid_to_parts = *std::max_element(to_parts.begin(), to_parts.end()) / diagonal;
    quality.parts_to_solid = *std::max_element(to_solid.begin(), to_solid.end()) / diagonal;
    quality.mean_parts_to_solid =
        std::accumulate(to_solid.begin(), to_solid.end(), 0.0) / to_solid.size() / diagonal;
  }
  quality.concavity = std::max(quality.solid_to_parts, quality.parts_to_solid);
  quality.coverage = CoveredShare(on_solid, set, options.coverage_tolerance * diagonal);
  MeasureVolumes(solid, tree, set, parts, options, &quality);
  return quality;
}

double Coverage(const core::TriangleMesh& solid, const std::vector<core::TriangleMesh>& parts,
                const ConcavityOptions& options) {
  RequireParts(solid, parts, options);
  const double diagonal = core::Bounds(solid).diagonal().norm();
  return CoveredShare(SampleSurface(solid, options.surface_samples, options.seed), PartSet(parts),
                      options.coverage_tolerance * diagonal);
}

double HausdorffToHull(const core::TriangleMesh& mesh, const core::TriangleMesh& hull, int samples,
                       std::uint64_t seed) {
  RequireMesh(mesh, "hull distance");
  RequireMesh(hull, "hull distance");
  const TriangleTree mesh_tree(mesh), hull_tree(hull);
  double farthest = 0.0;
  for (const Vector3d& p : SampleSurface(hull, samples, seed)) {
    if (!mesh_tree.Within(p, farthest)) farthest = mesh_tree.Closest(p).distance;
  }
  for (const Vector3d& p : SampleSurface(mesh, samples, seed + 1)) {
    if (!hull_tree.Within(p, farthest)) farthest = hull_tree.Closest(p).distance;
  }
  return farthest;
}

double Concavity(const core::TriangleMesh& mesh, const core::TriangleMesh& hull, int samples,
                 std::uint64_t seed) {
  const double excess = std::max(0.0, SignedVolume(hull) - SignedVolume(mesh));
  const double radius = std::cbrt(3.0 * excess / (4.0 * std::numbers::pi));
  return std::max(0.3 * radius, HausdorffToHull(mesh, hull, samples, seed));
}

}  // namespace simwright::geometry
