#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "core/mesh.h"

namespace simwright::capture {

// Views of an object with the renderer's truth.
struct RenderedViews {
  std::vector<asset_lift::ObservedView> views;  // colours with noise, true masks, no depths
  std::vector<std::vector<float>> depths;       // the truth, per view, m; 0: background
  core::TriangleMesh hull;                      // of the true masks
  double diagonal = 0.0;                        // the object's, m
};

// Renders an object that stands on z = 0 from three rings, 220 pixels a side, the object about 190.
RenderedViews RenderViews(const core::TexturedMesh& object, int count);

}  // namespace simwright::capture
