#pragma once

#include <memory>
#include <vector>

#include "core/camera.h"
#include "nn/torch.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// What a drawn picture is, as tensors: color (H x W x 3), mask (H x W), depth (H x W);
// premultiplied by coverage, float32.
struct DrawnTensors {
  torch::Tensor color, mask, depth;
};

// The differentiable renderer as a node of libtorch's graph: draws object 0 of `renderer` with
// `vertices` (N x 3, object frame, m) and `vertex_colors` (N x 3, or undefined) from `camera`; the
// tensors' backward runs the renderer's, and leads to both. Float64 vertices keep their precision.
// The picture is drawn anew when the gradient is asked for after another was drawn, so several
// pictures may share one graph. `renderer` must outlive the graph.
// Throws core::Error where sizes do not fit.
DrawnTensors DrawTensors(render::DifferentiableRenderer* renderer, const torch::Tensor& vertices,
                         const torch::Tensor& vertex_colors, const core::Camera& camera,
                         std::uint64_t seed);

}  // namespace simwright::asset_lift
