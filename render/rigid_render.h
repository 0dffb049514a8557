#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "render/rigid_scene.h"

namespace simwright::render {

// Memory of the caller for one image, rows from the top. Null buffers are not computed.
struct ImageBuffers {
  std::uint8_t* rgb = nullptr;    // (height x width x 3), sRGB
  float* depth = nullptr;         // (height x width), m along the optical axis; 0: nothing is hit
  std::int32_t* label = nullptr;  // (height x width), of the part or backdrop; -1: nothing is hit
  // (height x width x 3), unit, world frame, facing the camera; 0: nothing is hit.
  float* normal = nullptr;

  bool empty() const { return !rgb && !depth && !label && !normal; }
};

struct RigidRenderOptions {
  // The colour of a pixel is the mean over N x N rays; the other buffers come from one of them, the
  // pixel's centre for odd N.
  int samples_per_side = 1;
};

// Renders the scene into the buffers. Tiles of 4 x 4 pixels are traced as packets; rows of tiles
// are distributed over up to core::ThreadCount() threads, and the bytes do not depend on their
// number. Does nothing without a buffer. Throws core::Error for a camera without pixels or
// samples_per_side < 1.
void RenderRigid(const RigidScene& scene, const core::Camera& camera, const ImageBuffers& buffers,
                 const RigidRenderOptions& options = {});

// One image of a batch.
struct RigidView {
  const RigidScene* scene = nullptr;
  core::Camera camera;
  ImageBuffers buffers;
};

// Renders many images, distributed over up to core::ThreadCount() threads: the bytes of RenderRigid
// for each. Throws core::Error as RenderRigid does.
void RenderRigidBatch(const std::vector<RigidView>& views, const RigidRenderOptions& options = {});

}  // namespace simwright::render
