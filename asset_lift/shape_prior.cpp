#include "asset_lift/shape_prior.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "asset_lift/shape_example.h"
#include "asset_lift/shape_network.h"
#include "core/error.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"

namespace simwright::asset_lift {
namespace {

constexpr size_t kPixels = static_cast<size_t>(kCropSide) * kCropSide;
// A pixel of the outline has something behind it: its most likely cells are lifted to these odds.
constexpr float kLeastPeak = 0.7f;
constexpr float kEmpty = -8.0f;

// The outline's say: nothing beside it, something behind each of its pixels.
void HoldToOutline(ShapePrediction* prediction) {
  for (size_t pixel = 0; pixel < kPixels; ++pixel) {
    const bool seen = prediction->crop.pixels[4 * pixel + 3] > 127;
    float peak = -1e30f;
    for (int k = 0; k < kDepthCells; ++k) {
      peak = std::max(peak, prediction->logits[static_cast<size_t>(k) * kPixels + pixel]);
    }
    const float lift = seen ? std::max(0.0f, kLeastPeak - peak) : 0.0f;
    int first = -1, last = -1;
    for (int k = 0; k < kDepthCells; ++k) {
      float& logit = prediction->logits[static_cast<size_t>(k) * kPixels + pixel];
      // Beside the outline the volume goes on smoothly; Logit() cuts it at the outline itself.
      logit = std::max(kEmpty, logit + lift);
      if (logit <= 0.0f) continue;
      if (first < 0) first = k;
      last = k;
    }
    if (first < 0) continue;
    const auto w = [](int k) {
      return static_cast<float>(kDepthReach * ((k + 0.5) * 2.0 / kDepthCells - 1.0));
    };
    prediction->front_w[pixel] = w(first);
    prediction->back_w[pixel] = w(last);
  }
}

}  // namespace

struct ShapePrior::Network {
  mutable ShapeNetwork module;
  torch::Device device = nn::BestDevice();
};

ShapePrior::ShapePrior(const std::filesystem::path& weights)
    : network_(std::make_unique<Network>()) {
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
  if (crops.size() != frames.size()) throw core::Error("a crop has one frame");
  nn::UseThreads();
  std::vector<torch::Tensor> pictures;
  for (const core::Image& crop : crops) {
    if (crop.width != kCropSide || crop.height != kCropSide || crop.channels != 4) {
      throw core::Error("the shape prior sees RGBA crops of 64 x 64 pixels");
    }
    pictures.push_back(PicturesFromRgba(crop.pixels.data(), 1, kCropSide));
  }
  const torch::NoGradGuard no_grad;
  const ShapeNetworkOutput output = network_->module(torch::cat(pictures).to(network_->device));
  const torch::Tensor logits = output.occupancy.to(torch::kCPU).contiguous();
  const torch::Tensor back = (output.back.clamp(0.0, 1.0) * 255.0)
                                 .round()
                                 .to(torch::kCPU, torch::kUInt8)
                                 .permute({0, 2, 3, 1})
                                 .contiguous();
  const torch::Tensor elevation = output.elevation.to(torch::kCPU).contiguous();
  std::vector<ShapePrediction> predictions(crops.size());
  for (size_t i = 0; i < crops.size(); ++i) {
    ShapePrediction& p = predictions[i];
    const auto at = static_cast<std::int64_t>(i);
    p.frame = frames[i];
    p.crop = crops[i];
    p.back = core::Image(kCropSide, kCropSide, 3);
    std::memcpy(p.back.pixels.data(), back[at].data_ptr(), 3 * kPixels);
    p.logits.resize(kPixels * kDepthCells);
    std::memcpy(p.logits.data(), logits[at].data_ptr(), p.logits.size() * sizeof(float));
    p.front_w.assign(kPixels, 0.0f);
    p.back_w.assign(kPixels, 0.0f);
    p.elevation = elevation[at][0].item<double>();
    p.elevation_deviation = std::exp(std::clamp(elevation[at][1].item<double>(), -4.0, 1.0));
    HoldToOutline(&p);
    p.box = FilledBox(p);
  }
  return predictions;
}

}  // namespace simwright::asset_lift
