#include "asset_lift/priors/learned_view_prior.h"

#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_network.h"
#include "asset_lift/priors/view_network.h"
#include "asset_lift/priors/view_prior.h"
#include "core/error.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"

namespace simwright::asset_lift {
namespace {

class LearnedViewPrior : public ViewPrior {
 public:
  LearnedViewPrior(const std::filesystem::path& weights, std::shared_ptr<const ShapePrior> shape)
      : shape_(std::move(shape)),
        device_(nn::BestDevice()),
        schedule_(nn::DiffusionSchedule::Cosine(kViewDiffusionSteps)) {
    nn::LoadCheckpoint(weights, "view", network_.get());
    network_->to(device_);
    network_->eval();
  }

  int side() const override { return kViewSide; }
  const nn::DiffusionSchedule& schedule() const override { return schedule_; }

  void SetReference(const ReferenceView& view) override {
    prediction_ = shape_->Predict(CropImage(view.photo, view.alpha, view.frame), view.frame);
    taken_ = PicturesFromRgba(prediction_.crop.pixels.data(), 1, kCropSide).to(device_);
  }

  torch::Tensor Encode(const torch::Tensor& pictures) override {
    return 2.0 * pictures.to(device_) - 1.0;
  }

  torch::Tensor PredictNoise(const torch::Tensor& noisy, const torch::Tensor& t,
                             const std::vector<core::Camera>& cameras, bool conditioned) override {
    if (prediction_.logits.empty()) throw core::Error("a view prior needs a reference first");
    std::vector<torch::Tensor> rendered, camera;
    for (core::Camera at : cameras) {
      camera.push_back(CameraTensor(prediction_.frame.camera, at));
      if (!conditioned) continue;
      const double scale = static_cast<double>(kViewSide) / at.width;
      at.width = at.height = kViewSide;
      at.fx *= scale;
      at.fy *= scale;
      at.cx *= scale;
      at.cy *= scale;
      rendered.push_back(
          PredictionTensor(RenderPrediction(prediction_, at), at, prediction_.frame.Radius()));
    }
    const auto batch = noisy.size(0);
    const torch::Tensor empty = torch::zeros({batch, 5, kViewSide, kViewSide}, device_);
    const torch::Tensor none = torch::zeros({batch, 4, kViewSide, kViewSide}, device_);
    return network_(noisy, conditioned ? torch::cat(rendered).to(device_) : empty,
                    conditioned ? taken_.expand({batch, 4, kViewSide, kViewSide}) : none,
                    torch::cat(camera).to(device_), t.to(device_));
  }

 private:
  std::shared_ptr<const ShapePrior> shape_;
  torch::Device device_;
  nn::DiffusionSchedule schedule_;
  ViewNetwork network_;
  ShapePrediction prediction_;
  torch::Tensor taken_;
};

}  // namespace

std::shared_ptr<ViewPrior> LoadLearnedViewPrior(const std::filesystem::path& weights,
                                                std::shared_ptr<const ShapePrior> shape) {
  return std::make_shared<LearnedViewPrior>(weights, std::move(shape));
}

}  // namespace simwright::asset_lift
