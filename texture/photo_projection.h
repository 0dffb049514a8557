#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::texture {

struct ProjectionOptions {
  int texture_size = 1024;  // pixels a side; doubled where the surface's pieces do not fit
  // Photo colours fade out between these cosines of the angle to the viewer: at the rim a pixel
  // smears over much surface and mixes with the background.
  double fade_from = 0.35, fade_to = 0.12;
  // Pixels next to the matte's edge are mixed with the background: so many are left out.
  int edge_pixels = 2;
};

// A photo of the object, with its camera and matte (1 channel, the photo's size).
struct PhotoView {
  core::Camera camera;
  core::Image photo;
  core::Image alpha;
};

// The mesh textured from one photo: what the camera sees takes the photo's colours; the rest takes
// those of the mirror image across `mirror` (a plane through the object: the back repeats the
// front), and what even the mirror does not show takes the colours around it, spread over the
// surface. `alpha` (1 channel, the photo's size) is the object's matte.
// Throws core::Error when the camera sees nothing of the mesh, or sizes do not fit.
core::TexturedMesh ProjectPhoto(const core::TriangleMesh& mesh, const core::Camera& camera,
                                const core::Image& photo, const core::Image& alpha,
                                const Eigen::Hyperplane<double, 3>& mirror,
                                const ProjectionOptions& options = {});

// The mesh textured from one or more photos: what several cameras see takes their colours weighed
// by how squarely they look; what none sees takes `hidden` (N x 3, sRGB in [0, 1], a colour a
// vertex), blended in where the photos fade. Throws core::Error when no camera sees anything of the
// mesh, there is no photo, or sizes do not fit.
core::TexturedMesh ProjectPhotos(const core::TriangleMesh& mesh,
                                 const std::vector<PhotoView>& views,
                                 const std::vector<Eigen::Vector3f>& hidden,
                                 const ProjectionOptions& options = {});

}  // namespace simwright::texture
