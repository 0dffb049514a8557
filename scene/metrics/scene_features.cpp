#include "scene/metrics/scene_features.h"

#include <algorithm>

#include "core/error.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/torch_script.h"
#include "scene/metrics/feature_network.h"

namespace simwright::scene {

struct SceneFeatures::Network {
  std::string name;
  int width = kFeatureWidth, height = kFeatureHeight;  // pixels
  FeatureNetwork own{nullptr};
  mutable torch::jit::script::Module script;
  torch::Device device = torch::kCPU;

  torch::Tensor Forward(const torch::Tensor& pictures) const {
    if (!own.is_empty()) return own.ptr()->Features(pictures);
    try {
      const torch::jit::IValue value = script.forward({pictures});
      if (!value.isTensor()) throw core::Error("it does not return a tensor", name);
      return value.toTensor();
    } catch (const c10::Error& error) {
      throw core::Error("it cannot process images: " + error.msg(), name);
    }
  }
};

SceneFeatures::SceneFeatures(std::unique_ptr<Network> network) : network_(std::move(network)) {}
SceneFeatures::~SceneFeatures() = default;
SceneFeatures::SceneFeatures(SceneFeatures&&) noexcept = default;
SceneFeatures& SceneFeatures::operator=(SceneFeatures&&) noexcept = default;

SceneFeatures SceneFeatures::Load(const std::filesystem::path& weights) {
  auto network = std::make_unique<Network>();
  network->name = "simwright scene features";
  network->own = FeatureNetwork();
  nn::LoadCheckpoint(weights, kFeatureKind, network->own.ptr().get());
  network->own->eval();
  network->device = nn::BestDevice();
  network->own->to(network->device);
  return SceneFeatures(std::move(network));
}

SceneFeatures SceneFeatures::LoadTorchScript(const std::filesystem::path& module, int side) {
  if (side < 1) throw core::Error("images must be at least 1 pixel wide", module.string());
  auto network = std::make_unique<Network>();
  network->name =
      module.string() + " (" + std::to_string(side) + " x " + std::to_string(side) + ")";
  network->width = network->height = side;
  network->script = nn::LoadTorchScript(module);
  network->script.eval();
  network->device = nn::BestDevice();
  network->script.to(network->device);
  return SceneFeatures(std::move(network));
}

bool SceneFeatures::own() const {
  return !network_->own.is_empty();
}

const std::string& SceneFeatures::name() const {
  return network_->name;
}

core::Image SceneFeatures::Resized(const core::Image& picture) const {
  return core::Resize(picture, network_->width, network_->height);
}

FeatureMatrix SceneFeatures::Of(const std::vector<core::Image>& pictures) const {
  nn::PrepareForWork();
  const torch::NoGradGuard no_gradient;
  const torch::Tensor input = PictureTensor(pictures);
  if (input.size(3) != network_->width || input.size(2) != network_->height) {
    throw core::Error("the images do not have the input size of the feature network", name());
  }
  const torch::Tensor output = network_->Forward(input.to(network_->device));
  if (output.dim() < 1 || output.size(0) != input.size(0)) {
    throw core::Error("it does not return one row of features per image", name());
  }
  const torch::Tensor rows =
      output.reshape({input.size(0), -1}).to(torch::kCPU, torch::kFloat32).contiguous();
  FeatureMatrix features(rows.size(0), rows.size(1));
  std::copy_n(rows.data_ptr<float>(), rows.numel(), features.data());
  if (!features.allFinite()) throw core::Error("the features of an image are not finite", name());
  return features;
}

}  // namespace simwright::scene
