#include "geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kDistanceBlock = 1024;  // points per task; also the unit of the random streams

void RequireFaces(const core::TriangleMesh& mesh, const char* where) {
  core::RequireValid(mesh, where);
  if (mesh.empty()) throw core::Error("the mesh has no faces", where);
}

int SampleBlocks(std::size_t count) {
  return static_cast<int>((count + kDistanceBlock - 1) / kDistanceBlock);
}

std::vector<double> Distances(const std::vector<Vector3d>& points, const TriangleTree& tree) {
  std::vector<double> distances(points.size());
  core::ParallelFor(SampleBlocks(points.size()), [&](int block) {
    core::CheckCancelled();
    const std::size_t end =
        std::min(points.size(), static_cast<std::size_t>(block + 1) * kDistanceBlock);
    for (std::size_t i = static_cast<std::size_t>(block) * kDistanceBlock; i < end; ++i) {
      distances[i] = tree.Closest(points[i]).distance;
    }
  });
  return distances;
}

OuterHit Seen(const core::TriangleMesh& mesh, const SurfacePoint& hit, const Vector3d& to_eye) {
  Vector3d normal = core::TriangleAreaVector(mesh, hit.triangle).normalized();
  if (normal.dot(to_eye) < 0.0) normal = -normal;
  return {hit.point, to_eye, normal};
}

std::vector<OuterHit> OuterHits(const core::TriangleMesh& mesh, const TriangleTree& tree, int rays,
                                std::uint64_t seed) {
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh);
  const Vector3d center = bounds.center();
  const double radius = 0.5 * bounds.diagonal().norm() * 1.001;
  const int blocks = SampleBlocks(std::max(rays, 0));
  std::vector<std::vector<OuterHit>> hits(blocks);
  core::ParallelFor(blocks, [&](int block) {
    core::CheckCancelled();
    core::Rng rng = core::StreamRng(seed, block);
    const int count = std::min(kDistanceBlock, rays - block * kDistanceBlock);
    for (int i = 0; i < count; ++i) {
      // The chord through two uniform points of a sphere is uniform and isotropic (Santalo 1976).
      const Vector3d from = center + radius * core::UniformDirection(rng);
      const Vector3d to = center + radius * core::UniformDirection(rng);
      if (const auto hit = tree.FirstHit(from, to - from, 1.0)) {
        hits[block].push_back(Seen(mesh, *hit, (from - to).normalized()));
        if (const auto back = tree.FirstHit(to, from - to, 1.0)) {
          hits[block].push_back(Seen(mesh, *back, (to - from).normalized()));
        }
      }
    }
  });
  std::vector<OuterHit> all;
  for (const auto& some : hits) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void MaxAndPercentile(std::vector<double> distances, double* max, double* p99) {
  if (distances.empty()) return;
  *max = *std::max_element(distances.begin(), distances.end());
  const std::size_t rank = static_cast<std::size_t>(0.99 * (distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
  *p99 = distances[rank];
}

}  // namespace

double SurfaceDistance::MaxRatio() const {
  return std::max(visual_to_solid_max, solid_to_visual_max) / diagonal;
}

std::vector<OuterHit> SampleOuterHits(const core::TriangleMesh& mesh, int rays,
                                      std::uint64_t seed) {
  RequireFaces(mesh, "outer surface");
  return OuterHits(mesh, TriangleTree(mesh), rays, seed);
}

std::vector<Vector3d> SampleOuterSurface(const core::TriangleMesh& mesh, int rays,
                                         std::uint64_t seed) {
  std::vector<Vector3d> points;
  for (const OuterHit& hit : SampleOuterHits(mesh, rays, seed)) points.push_back(hit.point);
  return points;
}

std::vector<Vector3d> SampleSurface(const core::TriangleMesh& mesh, int count, std::uint64_t seed) {
  RequireFaces(mesh, "surface samples");
  std::vector<double> cumulative(mesh.triangles.size());
  double area = 0.0;
  for (std::size_t t = 0; t < cumulative.size(); ++t) {
    area += 0.5 * core::TriangleAreaVector(mesh, static_cast<int>(t)).norm();
    cumulative[t] = area;
  }
  if (!(area > 0.0)) throw core::Error("the mesh has no area", "surface samples");
  core::Rng rng = core::StreamRng(seed, 0);
  std::vector<Vector3d> points;
  points.reserve(std::max(count, 0));
  for (int i = 0; i < count; ++i) {
    // Stratified along the cumulative area.
    const double at = area * (i + core::Uniform(rng)) / count;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), at);
    const std::size_t t = std::min<std::size_t>(found - cumulative.begin(), cumulative.size() - 1);
    const double root = std::sqrt(core::Uniform(rng));
    const double v = core::Uniform(rng);
    const Eigen::Vector3i& corner = mesh.triangles[t];
    points.push_back((1.0 - root) * mesh.vertices[corner[0]] +
                     root * (1.0 - v) * mesh.vertices[corner[1]] +
                     root * v * mesh.vertices[corner[2]]);
  }
  return points;
}

std::vector<double> DistancesToSurface(const std::vector<Vector3d>& points,
                                       const core::TriangleMesh& mesh) {
  RequireFaces(mesh, "distance to a surface");
  return Distances(points, TriangleTree(mesh));
}

SurfaceDistance OuterSurfaceDistance(const core::TriangleMesh& visual,
                                     const core::TriangleMesh& solid,
                                     const SurfaceDistanceOptions& options) {
  RequireFaces(visual, "surface distance, visual mesh");
  RequireFaces(solid, "surface distance, solid");
  SurfaceDistance result;
  result.diagonal = core::Bounds(visual).diagonal().norm();
  if (!(result.diagonal > 0.0)) {
    throw core::Error("the mesh has no extent", "surface distance, visual mesh");
  }
  const TriangleTree visual_tree(visual);
  const TriangleTree solid_tree(solid);
  std::vector<Vector3d> outer;
  for (const OuterHit& hit : OuterHits(visual, visual_tree, options.rays, options.seed)) {
    outer.push_back(hit.point);
  }
  result.outer_points = static_cast<int>(outer.size());
  MaxAndPercentile(Distances(outer, solid_tree), &result.visual_to_solid_max,
                   &result.visual_to_solid_p99);
  const std::vector<Vector3d> on_solid =
      SampleSurface(solid, options.solid_samples, options.seed + 1);
  MaxAndPercentile(Distances(on_solid, visual_tree), &result.solid_to_visual_max,
                   &result.solid_to_visual_p99);
  return result;
}

}  // namespace simwright::geometry
