#include "asset_lift/priors/shape_prior.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_network.h"
#include "asset_lift/priors/silhouette_consistency.h"
#include "core/error.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"

namespace simwright::asset_lift {
namespace {

constexpr size_t kPriorPixels = static_cast<size_t>(kCropSide) * kCropSide;
}  // namespace

struct ShapePrior::Network {
  explicit Network(const ShapeNetworkOptions& options) : module(options) {}

  mutable ShapeNetwork module;
  torch::Device device = nn::BestDevice();
};

ShapePrior::ShapePrior(const std::filesystem::path& weights)
    : network_(std::make_unique<Network>(ShapeNetworkOptions::Of(weights))) {
  nn::LoadCheckpoint(weights, "shape", network_->module.get());
  network_->module->to(network_->device);
  network_->module->eval();
}

ShapePrior::~ShapePrior() = default;

ShapePrediction ShapePrior::Predict(const core::Image& crop, const ViewFrame& frame) const {
  return Predict(std::vector<core::Image>{crop}, std::vector<ViewFrame>{frame}).front();
}

std::vector<ShapePrediction> ShapePrior::Predict(const std::vector<core::Image>& crops,
                                                 const std::vector<ViewFrame>& frames) const {
  if (crops.size() != frames.size()) throw core::Error("crops and frames must be equal in number");
  nn::PrepareForWork();
  std::vector<torch::Tensor> pictures;
  for (const core::Image& crop : crops) {
    if (crop.width != kCropSide || crop.height != kCropSide || crop.channels != 4) {
      throw core::Error("the shape prior needs RGBA crops of 64 x 64 pixels");
    }
    pictures.push_back(PicturesFromRgba(crop.pixels.data(), 1, kCropSide));
  }
  const torch::NoGradGuard no_grad;
  // A mirrored photo is a photo of the mirrored object: the two predictions are averaged, because
  // their errors differ.
  const torch::Tensor seen = torch::cat(pictures).to(network_->device);
  const ShapeNetworkOutput output = network_->module(seen);
  const ShapeNetworkOutput mirrored = network_->module(seen.flip(3));
  const auto mean = [](const torch::Tensor& a, const torch::Tensor& b) {
    return (0.5 * (a + b)).to(torch::kCPU).contiguous();
  };
  const torch::Tensor logits = mean(output.occupancy, mirrored.occupancy.flip(3));
  const torch::Tensor back = (mean(output.back, mirrored.back.flip(3)).clamp(0.0, 1.0) * 255.0)
                                 .round()
                                 .to(torch::kUInt8)
                                 .permute({0, 2, 3, 1})
                                 .contiguous();
  const torch::Tensor elevation = mean(output.elevation, mirrored.elevation);
  std::vector<ShapePrediction> predictions(crops.size());
  for (size_t i = 0; i < crops.size(); ++i) {
    ShapePrediction& p = predictions[i];
    const auto at = static_cast<std::int64_t>(i);
    p.frame = frames[i];
    p.crop = crops[i];
    p.back = core::Image(kCropSide, kCropSide, 3);
    std::memcpy(p.back.pixels.data(), back[at].data_ptr(), 3 * kPriorPixels);
    p.logits.resize(kPriorPixels * kDepthCells);
    std::memcpy(p.logits.data(), logits[at].data_ptr(), p.logits.size() * sizeof(float));
    p.elevation = elevation[at][0].item<double>();
    p.elevation_deviation = std::exp(std::clamp(elevation[at][1].item<double>(), -4.0, 1.0));
    EnforceSilhouetteConsistency(&p);
    p.box = FilledBox(p);
  }
  return predictions;
}

}  // namespace simwright::asset_lift
