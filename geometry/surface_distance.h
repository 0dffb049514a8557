#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

struct SurfaceDistanceOptions {
  int rays = 50000;           // chords through the visual's bounding sphere, two ends each
  int solid_samples = 50000;  // points on the solid, uniform by area
  std::uint64_t seed = 1;
};

// Distances in both directions, in metres and as a share of the visual mesh's AABB diagonal.
struct SurfaceDistance {
  double visual_to_solid_max = 0.0;  // from points of the visual's outer surface to the solid
  double visual_to_solid_p99 = 0.0;
  double solid_to_visual_max = 0.0;  // from points of the solid to the visual (all of it)
  double solid_to_visual_p99 = 0.0;
  double diagonal = 0.0;  // m
  int outer_points = 0;   // ray hits that sample the outer surface

  double MaxRatio() const;  // the larger of both maxima over the diagonal
};

// Measures the distances between the outer surface of `visual` and `solid`. The outer surface is
// what a ray from outside can hit: the first hits of `rays` random chords of the bounding sphere,
// from both ends (isotropic: each piece of the surface is sampled in proportion to area times
// visibility). Deterministic for a seed, whatever the thread count. Throws core::Error if one of
// the meshes has no faces or is invalid.
SurfaceDistance OuterSurfaceDistance(const core::TriangleMesh& visual,
                                     const core::TriangleMesh& solid,
                                     const SurfaceDistanceOptions& options = {});

// A point of the outer surface and the direction from which it was seen.
struct OuterHit {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_eye = Eigen::Vector3d::UnitX();  // unit
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // unit, of the face, towards the eye
};

// Returns the first hits of chords from outside, as in OuterSurfaceDistance; at most 2 `rays`.
std::vector<OuterHit> SampleOuterHits(const core::TriangleMesh& mesh, int rays, std::uint64_t seed);

// Returns only the points of SampleOuterHits. (K x 3)
std::vector<Eigen::Vector3d> SampleOuterSurface(const core::TriangleMesh& mesh, int rays,
                                                std::uint64_t seed);

// Samples points uniformly by area. (count x 3). Throws core::Error for a mesh without area.
std::vector<Eigen::Vector3d> SampleSurface(const core::TriangleMesh& mesh, int count,
                                           std::uint64_t seed);

// Returns the unsigned distance from each point to the mesh, metres.
std::vector<double> DistancesToSurface(const std::vector<Eigen::Vector3d>& points,
                                       const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
