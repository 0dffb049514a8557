#include "scene/model/loss_means.h"

#include <cmath>

namespace simwright::scene {
namespace {

// The order of TermsOf.
constexpr double LossRecord::*kTermMembers[] = {&LossRecord::total, &LossRecord::translation,
                                                &LossRecord::rotation, &LossRecord::classes,
                                                &LossRecord::cross_entropy};
constexpr std::int64_t kTerms = 5;

}  // namespace

torch::Tensor TermsOf(const SceneLoss& loss) {
  return torch::stack(
             {loss.total, loss.translation, loss.rotation, loss.divergence, loss.cross_entropy})
      .detach()
      .to(torch::kFloat);
}

void LossMeans::Add(const std::vector<SceneLoss>& losses, const std::vector<double>& shares) {
  for (size_t i = 0; i < losses.size(); ++i) {
    if (shares[i] == 0.0) continue;
    sums_.total += shares[i] * losses[i].total.item<double>();
    sums_.translation += shares[i] * losses[i].translation.item<double>();
    sums_.rotation += shares[i] * losses[i].rotation.item<double>();
    sums_.classes += shares[i] * losses[i].divergence.item<double>();
    sums_.cross_entropy += shares[i] * losses[i].cross_entropy.item<double>();
  }
  ++count_;
}

void LossMeans::AddOnDevice(const torch::Tensor& terms) {
  const torch::NoGradGuard no_gradient;
  const torch::Tensor one = torch::cat({terms, torch::ones({1}, terms.options())});
  const torch::Tensor counted =
      torch::where(torch::isfinite(terms[0]), one, torch::zeros_like(one)).to(torch::kDouble);
  if (!device_sums_.defined()) device_sums_ = torch::zeros_like(counted);
  device_sums_.add_(counted);
}

LossRecord LossMeans::Take(int step) {
  if (device_sums_.defined()) {
    const torch::Tensor sums = device_sums_.to(torch::kCPU);
    for (std::int64_t i = 0; i < kTerms; ++i) sums_.*kTermMembers[i] += sums[i].item<double>();
    count_ += static_cast<int>(sums[kTerms].item<double>());
    device_sums_ = torch::Tensor();
  }
  LossRecord mean = sums_;
  mean.step = step;
  for (double LossRecord::*const member : kTermMembers) {
    mean.*member = count_ > 0 ? mean.*member / count_ : NAN;
  }
  sums_ = {};
  count_ = 0;
  return mean;
}

}  // namespace simwright::scene
