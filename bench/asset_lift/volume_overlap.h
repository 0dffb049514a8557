#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::bench {

// The intersection over union of volumes with the true solid, each in [0, 1].
struct VolumeOverlaps {
  double ours = 0.0;
  // The baselines from a silhouette: the ellipsoid with the moments of the mask, as deep as its
  // smaller half axis in the image; and the mask, extruded by as much to both sides.
  double ellipsoid = 0.0;
  double extrusion = 0.0;
};

// Compares volumes; both meshes are closed, in `camera`'s world. The depth of an image is free up
// to scale: each mesh is scaled from the camera until the middle of its range of depths is at
// `depth`. Uses `points` points sampled with `seed`, inside by the parity of a ray.
VolumeOverlaps CompareVolumes(const core::TriangleMesh& truth, const core::TriangleMesh& ours,
                              const core::Camera& camera, const asset_lift::Matte& matte,
                              double depth, int points, std::uint64_t seed);

}  // namespace simwright::bench
