#include "asset_lift/priors/view_network.h"

#include <cmath>

#include "asset_lift/priors/image_tensor.h"

namespace simwright::asset_lift {
ViewNetworkImpl::ViewNetworkImpl(const ViewNetworkOptions& options)
    : embedding_(options.embedding) {
  nn::UNetOptions body;
  body.in_channels = 4 + 5 + 4;
  body.out_channels = 4;
  body.channels = options.channels;
  body.embedding = options.embedding;
  body_ = register_module("body", nn::UNet(body));
  time_ = register_module("time", torch::nn::Linear(embedding_, embedding_));
  camera_ = register_module("camera", torch::nn::Linear(5, embedding_));
  mixed_ = register_module("mixed", torch::nn::Linear(embedding_, embedding_));
}

torch::Tensor ViewNetworkImpl::forward(const torch::Tensor& noisy, const torch::Tensor& rendered,
                                       const torch::Tensor& taken, const torch::Tensor& camera,
                                       const torch::Tensor& t) {
  const torch::Tensor embedding =
      mixed_(torch::silu(time_(nn::SinusoidalEmbedding(t, embedding_)) + camera_(camera)));
  return body_(torch::cat({noisy, rendered, taken}, 1), embedding);
}

torch::Tensor PictureTensor(const ObjectImage& picture) {
  return 2.0 * torch::cat({TensorFromImage(picture.color), TensorFromImage(picture.opacity)}, 1) -
         1.0;
}

torch::Tensor PredictionTensor(const RenderedPrediction& rendered, const core::Camera& camera,
                               double radius) {
  const torch::Tensor opacity = TensorFromImage(rendered.picture.opacity);
  // Depth times opacity, minus the centre's depth times opacity: 0 for background.
  const torch::Tensor depth =
      (TensorFromImage(rendered.depth) - camera.position().norm() * opacity) /
      std::max(radius, 1e-6);
  return torch::cat({PictureTensor(rendered.picture), depth}, 1);
}

torch::Tensor CameraTensor(const core::Camera& reference, const core::Camera& camera) {
  const RelativeCamera r = RelativeTo(reference, camera);
  const Eigen::Vector3d from = reference.position();
  return torch::tensor({r.elevation, std::sin(r.azimuth), std::cos(r.azimuth), r.distance,
                        std::asin(from.z() / from.norm())},
                       torch::kFloat)
      .unsqueeze(0);
}

}  // namespace simwright::asset_lift
