#pragma once

#include <memory>
#include <vector>

#include "core/camera.h"
#include "nn/torch.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// A rendered image as tensors: color (H x W x 3), mask (H x W), depth (H x W); premultiplied by
// coverage, float32.
struct RenderedTensors {
  torch::Tensor color, mask, depth;
};

// Wraps the differentiable renderer as a node of libtorch's graph: renders object 0 of `renderer`
// with `vertices` (N x 3, object frame, m) and `vertex_colors` (N x 3, or undefined) from `camera`.
// The backward pass runs the renderer's and yields gradients of both. Float64 vertices keep their
// precision. If another image was rendered in between, the backward pass renders this one again, so
// several images may share one graph. `renderer` must outlive the graph. Throws core::Error where
// sizes do not match.
RenderedTensors RenderTensors(render::DifferentiableRenderer* renderer,
                              const torch::Tensor& vertices, const torch::Tensor& vertex_colors,
                              const core::Camera& camera, std::uint64_t seed);

}  // namespace simwright::asset_lift
