#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "render/light.h"
#include "render/scene.h"

namespace simwright::render {

struct ForwardOptions {
  int samples_per_side = 1;  // N x N rays per pixel, on a regular sub-grid
  bool shaded = false;       // fill `color`
  // If false, `color` holds the albedo itself.
  bool lit = true;
  SphericalHarmonicsLight light = SphericalHarmonicsLight::Studio({0.4f, -0.5f, 0.75f});
  int occlusion_rays = 0;  // ambient occlusion rays per hit; 0: none
  // Spreads the occlusion rays of a pixel's samples over the hemisphere together, so that two or
  // three a sample suffice; false: those of each sample by themselves.
  bool occlusion_per_pixel = false;
  float occlusion_reach = 0.25f;  // share of the scene's diagonal within which geometry occludes
  bool cancellable = false;       // Ctrl-C ends the image with core::Cancelled
};

// One value per pixel, rows from the top, (height x width).
struct ForwardBuffers {
  int width = 0, height = 0;
  std::vector<float> depth;             // along the optical axis, m; 0 where nothing is hit
  std::vector<Eigen::Vector3f> normal;  // world, unit, facing the camera; 0 where nothing is hit
  std::vector<float> mask;              // covered share of the pixel, [0, 1]
  std::vector<std::int32_t> label;      // instance, or -1
  std::vector<std::int32_t> triangle;   // of the instance's mesh, or -1
  core::Image color;                    // RGBA, sRGB, alpha is the mask; empty unless shaded

  std::size_t Index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

// Renders the scene into buffers, whose memory is used again from image to image; after
// core::Cancelled their contents are undefined. `depth`, `normal`,
// `label` and `triangle` come from one ray per pixel, through sub-sample (N/2, N/2): the pixel's
// centre for odd N. Tiles of pixels are traced as packets of rays and distributed over threads; the
// buffers do not depend on their number. Throws core::Error for a camera without pixels or
// samples_per_side < 1.
void RenderForward(const Scene& scene, const core::Camera& camera, const ForwardOptions& options,
                   ForwardBuffers* buffers);

// The same into new buffers.
ForwardBuffers RenderForward(const Scene& scene, const core::Camera& camera,
                             const ForwardOptions& options = {});

}  // namespace simwright::render
