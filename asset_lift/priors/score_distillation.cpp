#include "asset_lift/priors/score_distillation.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/priors/image_tensor.h"
#include "asset_lift/priors/view_prior.h"
#include "core/error.h"
#include "nn/compute.h"

namespace simwright::asset_lift {
namespace {

double Annealed(double first, double last, double anneal, double progress) {
  return first + (last - first) * std::min(1.0, progress / std::max(anneal, 1e-6));
}

// Samples noise from our own generator: the same seed gives the same fit, independent of libtorch's
// generator.
torch::Tensor NormalLike(const torch::Tensor& like, core::Rng* rng) {
  torch::Tensor noise = torch::empty(like.sizes(), torch::kFloat);
  float* value = noise.data_ptr<float>();
  for (std::int64_t i = 0; i < noise.numel(); ++i) {
    value[i] = static_cast<float>(core::Normal(*rng));
  }
  return noise.to(like.device());
}

}  // namespace

bool ScoreDistillationOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  for (const double t : {t_min_first, t_min_last, t_max_first, t_max_last}) {
    if (!(t >= 0.0 && t <= 1.0)) return fail("t_min and t_max must be in [0, 1]");
  }
  if (t_min_first > t_max_first || t_min_last > t_max_last) {
    return fail("t_min must be below t_max");
  }
  if (!(elevation_min < elevation_max) || std::abs(elevation_min) > 1.55 ||
      std::abs(elevation_max) > 1.55) {
    return fail("elevation_min must be below elevation_max, both within -1.55 .. 1.55 rad");
  }
  if (!(largest_gradient > 0.0) || side < 0) {
    return fail("side must not be negative and largest_gradient must be positive");
  }
  return true;
}

ScoreDistillation::ScoreDistillation(std::shared_ptr<ViewPrior> prior, const ViewFrame& frame,
                                     const core::Image& photo, const core::Image& alpha,
                                     const ScoreDistillationOptions& options)
    : prior_(std::move(prior)), frame_(frame), options_(options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "score distillation");
  nn::PrepareForWork();
  prior_->SetReference({frame, photo, alpha});
}

ScoreDistillation::~ScoreDistillation() = default;

core::Camera ScoreDistillation::NextCamera(double /*progress*/, core::Rng* rng) {
  return RandomCameraAround(frame_, options_.elevation_min, options_.elevation_max,
                            options_.side > 0 ? options_.side : prior_->side(), rng);
}

double ScoreDistillation::Evaluate(const core::Camera& camera, const ObjectImage& picture,
                                   double progress, core::Rng* rng, ObjectImage* gradient) {
  const double steps = prior_->schedule().steps();
  const double t_min =
      Annealed(options_.t_min_first, options_.t_min_last, options_.anneal, progress);
  const double t_max =
      Annealed(options_.t_max_first, options_.t_max_last, options_.anneal, progress);
  const torch::Tensor t =
      torch::full({1},
                  std::clamp<std::int64_t>(std::llround(steps * core::Uniform(*rng, t_min, t_max)),
                                           0, static_cast<std::int64_t>(steps) - 1),
                  torch::kLong);
  torch::Tensor given =
      torch::cat({TensorFromImage(picture.color), TensorFromImage(picture.opacity)}, 1);
  given.requires_grad_(true);
  const int side = prior_->side();
  const torch::Tensor seen =
      picture.color.width == side
          ? given
          : torch::adaptive_avg_pool2d(given, std::vector<std::int64_t>{side, side});
  const torch::Tensor latent = prior_->Encode(seen);
  torch::Tensor step;
  {
    const torch::NoGradGuard no_grad;
    const torch::Tensor clean = latent.detach();
    const torch::Tensor noise = NormalLike(clean, rng);
    const torch::Tensor noisy = prior_->schedule().AddNoise(clean, noise, t);
    torch::Tensor guess = prior_->PredictNoise(noisy, t, {camera}, true);
    if (options_.guidance != 1.0) {
      const torch::Tensor blind = prior_->PredictNoise(noisy, t, {camera}, false);
      guess = blind + options_.guidance * (guess - blind);
    }
    const torch::Tensor weight = prior_->schedule().Noise(t.to(clean.device())).square();
    step = torch::clamp(weight * (guess - noise), -options_.largest_gradient,
                        options_.largest_gradient);
  }
  latent.backward(step);
  *gradient = {core::FloatImage(picture.color.width, picture.color.height, 3),
               core::FloatImage(picture.color.width, picture.color.height, 1)};
  ImageFromTensor(given.grad(), 0, &gradient->color);
  ImageFromTensor(given.grad(), 3, &gradient->opacity);
  return 0.5 * step.square().mean().item<double>();
}

}  // namespace simwright::asset_lift
