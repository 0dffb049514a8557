#include "scene/model/class_shapes.h"

#include <cmath>

#include "core/error.h"

namespace simwright::scene {
namespace {

using torch::nn::Linear;

constexpr std::int64_t kFeatures = 64;
// m: far larger lengths enter by their logarithm, so that a room's floor and a cup fit one scale.
constexpr double kLength = 0.05;

}  // namespace

ClassShapesImpl::ClassShapesImpl(int classes, int points, std::int64_t entry, std::int64_t exit)
    : exit_(exit) {
  surfaces_ = register_buffer("surfaces", torch::zeros({classes - 1, points, 3}));
  point_ = register_module(
      "point",
      torch::nn::Sequential(Linear(3, kFeatures), torch::nn::SiLU(), Linear(kFeatures, kFeatures),
                            torch::nn::SiLU(), Linear(kFeatures, 2 * kFeatures)));
  whole_ = register_module(
      "whole", torch::nn::Sequential(Linear(2 * kFeatures, kFeatures), torch::nn::SiLU()));
  entry_map_ = register_module("entry_map", Linear(kFeatures, entry));
  key_map_ = register_module("key_map", Linear(kFeatures, exit));
  bias_map_ = register_module("bias_map", Linear(kFeatures, 1));
  own_entries_ = register_parameter("own_entries", torch::randn({2, entry}));
  empty_key_ = register_parameter("empty_key", torch::randn({exit}));
  empty_bias_ = register_parameter("empty_bias", torch::zeros({1}));
}

void ClassShapesImpl::Set(const AssetShapes& shapes) {
  const std::int64_t points = surfaces_.size(1);
  torch::Tensor surfaces =
      torch::empty({static_cast<std::int64_t>(shapes.surfaces.size()), points, 3}, torch::kFloat);
  if (surfaces.size(0) != surfaces_.size(0)) {
    throw core::Error("the number of shapes differs from the model's number of classes",
                      std::to_string(surfaces.size(0)));
  }
  float* out = surfaces.data_ptr<float>();
  for (const std::vector<Eigen::Vector3d>& surface : shapes.surfaces) {
    if (static_cast<std::int64_t>(surface.size()) != points) {
      throw core::Error("the number of points of a shape differs from the model's",
                        std::to_string(surface.size()), std::to_string(points) + " are needed");
    }
    for (const Eigen::Vector3d& point : surface) {
      for (int i = 0; i < 3; ++i) *out++ = static_cast<float>(point[i]);
    }
  }
  const torch::NoGradGuard no_gradient;
  surfaces_.copy_(surfaces);
}

AssetShapes ClassShapesImpl::Shapes() const {
  const torch::Tensor surfaces = surfaces_.to(torch::kCPU, torch::kDouble).contiguous();
  const double* in = surfaces.data_ptr<double>();
  AssetShapes shapes;
  shapes.surfaces.resize(static_cast<size_t>(surfaces.size(0)));
  for (std::vector<Eigen::Vector3d>& surface : shapes.surfaces) {
    for (std::int64_t i = 0; i < surfaces.size(1); ++i, in += 3) {
      surface.emplace_back(in[0], in[1], in[2]);
    }
  }
  return shapes;
}

torch::Tensor ClassShapesImpl::Features() {
  const torch::Tensor scaled = torch::asinh(surfaces_ / kLength);
  return whole_->forward(std::get<0>(point_->forward(scaled).max(1)));
}

torch::Tensor ClassShapesImpl::InputEmbeddings() {
  return torch::cat({entry_map_(Features()), own_entries_}, 0);
}

torch::Tensor ClassShapesImpl::Logits(const torch::Tensor& features) {
  const torch::Tensor asset_features = Features();
  const torch::Tensor keys = torch::cat({key_map_(asset_features), empty_key_.unsqueeze(0)}, 0);
  const torch::Tensor biases = torch::cat({bias_map_(asset_features).squeeze(-1), empty_bias_}, 0);
  return torch::matmul(features, keys.t()) / std::sqrt(static_cast<double>(exit_)) + biases;
}

}  // namespace simwright::scene
