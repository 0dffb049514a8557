#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::texture {

struct PhotoProjectionOptions {
  int texture_size = 1024;  // pixels per side; doubled if the charts do not fit
  // Photo colours fade out between these cosines of the angle to the viewer: near the silhouette a
  // pixel covers much surface and mixes with the background.
  double fade_from = 0.35, fade_to = 0.12;
  // The width of the band at the matte's edge that is left out, since it mixes with the background.
  int edge_pixels = 2;
};

// A photo of the object, with its camera and matte (1 channel, the photo's size).
struct PhotoView {
  core::Camera camera;
  core::Image photo;
  core::Image alpha;
};

// Textures the mesh from one photo. Surfaces that the camera sees take the photo's colours; the
// rest takes those of the mirror image across `mirror` (a plane through the object: the back
// repeats the front); surfaces that the mirror image misses too take the surrounding colours,
// diffused over the surface. `alpha` (1 channel, the photo's size) is the object's matte. Throws
// core::Error if the camera sees nothing of the mesh, or sizes do not match.
core::TexturedMesh ProjectPhoto(const core::TriangleMesh& mesh, const core::Camera& camera,
                                const core::Image& photo, const core::Image& alpha,
                                const Eigen::Hyperplane<double, 3>& mirror,
                                const PhotoProjectionOptions& options = {});

// Textures the mesh from one or more photos. Surfaces that several cameras see take their colours,
// weighted by how squarely they face the surface; unseen surfaces take `hidden` (N x 3, sRGB in [0,
// 1], one colour per vertex), blended in where the photos fade. Throws core::Error if no camera
// sees anything of the mesh, there is no photo, or sizes do not match.
core::TexturedMesh ProjectPhotos(const core::TriangleMesh& mesh,
                                 const std::vector<PhotoView>& views,
                                 const std::vector<Eigen::Vector3f>& hidden,
                                 const PhotoProjectionOptions& options = {});

}  // namespace simwright::texture
