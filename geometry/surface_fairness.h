#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

struct SurfaceFairnessOptions {
  int rays = 15000;  // chords that sample the outer surface, two ends each; >= 100
  double radius =
      0.03;  // of the diagonal, of the neighbourhood that normals are compared with; > 0
  std::uint64_t seed = 1;
};

// The smoothness of a surface at the scale of `radius`. Planes and large spheres are near 0; lumps
// and noise are not. Angles in rad.
struct SurfaceFairness {
  // The mean angle between the outer surface's normal and the mean normal around it. Sharp edges
  // count.
  double mean_deviation = 0.0;
  // The mean of the second and third quarter of those angles: sharp edges of few faces do not
  // count.
  double typical_deviation = 0.0;
};

// Measures the outer surface: what a ray from outside can hit (SampleOuterHits). Deterministic for
// a seed. Throws core::Error for an invalid mesh, one without faces, or invalid options.
SurfaceFairness MeasureFairness(const core::TriangleMesh& mesh,
                                const SurfaceFairnessOptions& options = {});

// A part of the outer surface that is about plane.
struct FlatFace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, outward
  double share = 0.0;                                 // of the outer surface, as chords hit it
  double deviation = 0.0;                             // root mean square distance to its plane, m
};

// Returns the faces of an outer surface as a boxy object has them, largest share first: points
// whose normals lie within 25 degrees of a common direction and that are no more than a tenth of
// the diagonal apart along it. `least_share`: smaller ones are not returned. The plane is fitted
// without the outermost tenth of a face's points (rounded edges) and without the fifth that is
// farthest from it (handles). Throws as MeasureFairness does.
std::vector<FlatFace> FindFlatFaces(const core::TriangleMesh& mesh, double least_share = 0.06,
                                    const SurfaceFairnessOptions& options = {});

// The difference between the two sides of a surface.
struct MirrorSymmetry {
  double azimuth = 0.0;     // rad in [0, pi), of the mirror plane's normal, from x towards y
  double difference = 0.0;  // mean distance of the mirrored outer surface to the surface, m
};

// Finds the vertical plane through the middle of the outer surface that mirrors it best. Throws as
// MeasureFairness does.
MirrorSymmetry FindMirrorSymmetry(const core::TriangleMesh& mesh,
                                  const SurfaceFairnessOptions& options = {});

}  // namespace simwright::geometry
