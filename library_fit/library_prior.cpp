#include "library_fit/library_prior.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "library_fit/library_network.h"
#include "nn/checkpoint.h"

namespace simwright::library_fit {
namespace {

std::vector<double> VectorOf(const torch::Tensor& values) {
  const torch::Tensor flat = values.to(torch::kDouble).contiguous();
  const auto* data = flat.data_ptr<double>();
  return {data, data + flat.numel()};
}

size_t LikeliestBin(const std::vector<double>& bins) {
  return static_cast<size_t>(std::max_element(bins.begin(), bins.end()) - bins.begin());
}

// Samples a bin, and uniformly within it: in [0, 1).
double SampledShare(const std::vector<double>& bins, core::Rng* rng) {
  double rest = core::Uniform(*rng);
  size_t bin = 0;
  while (bin + 1 < bins.size() && rest >= bins[bin]) rest -= bins[bin++];
  return (static_cast<double>(bin) + core::Uniform(*rng)) / static_cast<double>(bins.size());
}

double MiddleOf(const std::vector<double>& bins) {
  return (static_cast<double>(LikeliestBin(bins)) + 0.5) / static_cast<double>(bins.size());
}

double Laplace(double mean, double error, core::Rng* rng) {
  const double u = core::Uniform(*rng) - 0.5;
  return mean - error * std::copysign(std::log(std::max(1e-9, 1.0 - 2.0 * std::abs(u))), u);
}

}  // namespace

struct LibraryPrior::Network {
  LibraryNetwork net{nullptr};

  // Returns the probability of each kind: the mean of the answers for the picture (1 x 4 x S x S)
  // and its mirror image, since a mirrored object is of the same kind.
  std::vector<double> KindsOf(const torch::Tensor& picture) {
    const torch::Tensor both = torch::cat({picture, picture.flip(3)});
    const torch::Tensor logits = net->KindLogits(net->Features(both));
    return VectorOf(torch::softmax(logits, 1).mean(0));
  }
};

std::pair<Instance, FitView> LikeliestInstance(const KindPrediction& prediction) {
  Instance instance;
  instance.kind = prediction.kind;
  for (const std::vector<double>& bins : prediction.choices) {
    instance.draws.push_back(MiddleOf(bins));
  }
  if (FitKinds()[static_cast<size_t>(prediction.kind)].opening > 0.0) {
    instance.opening = MiddleOf(prediction.opening);
  }
  for (int i = 0; i < 3; ++i)
    instance.size[i] = std::exp(prediction.numbers[static_cast<size_t>(i)]);
  FitView view;
  view.azimuth = 2.0 * M_PI * MiddleOf(prediction.azimuth);
  view.elevation = prediction.numbers[3];
  view.nearness = std::clamp(prediction.numbers[4], kLeastNearness, kMostNearness);
  return {instance, view};
}

std::pair<Instance, FitView> SampledInstance(const KindPrediction& prediction, core::Rng* rng) {
  auto [instance, view] = LikeliestInstance(prediction);
  for (size_t i = 0; i < instance.draws.size(); ++i) {
    instance.draws[i] = SampledShare(prediction.choices[i], rng);
  }
  if (FitKinds()[static_cast<size_t>(prediction.kind)].opening > 0.0) {
    instance.opening = SampledShare(prediction.opening, rng);
  }
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<size_t>(i);
    instance.size[i] = std::exp(Laplace(prediction.numbers[at], prediction.errors[at], rng));
  }
  view.azimuth = 2.0 * M_PI * SampledShare(prediction.azimuth, rng);
  view.elevation =
      std::clamp(Laplace(prediction.numbers[3], prediction.errors[3], rng), -0.15, 1.35);
  view.nearness = std::clamp(Laplace(prediction.numbers[4], prediction.errors[4], rng),
                             kLeastNearness, kMostNearness);
  return {instance, view};
}

LibraryPrior::LibraryPrior(const std::filesystem::path& weights)
    : network_(std::make_unique<Network>()) {
  const nn::CheckpointMetadata card = nn::ReadCheckpointMetadata(weights, "library");
  const auto kinds = card.find("kinds");
  if (kinds == card.end() || kinds->second != std::to_string(FitKinds().size())) {
    throw core::Error("the library prior was trained for another list of kinds", weights.string(),
                      "train it again: simwright prior train --only library");
  }
  network_->net =
      LibraryNetwork(static_cast<int>(FitKinds().size()), LibraryNetworkOptions::Of(weights));
  nn::LoadCheckpoint(weights, "library", network_->net.get());
  network_->net->eval();
}

LibraryPrior::~LibraryPrior() = default;

std::vector<double> LibraryPrior::KindProbabilities(const core::Image& crop) const {
  const torch::NoGradGuard no_grad;
  return network_->KindsOf(LibraryPictures(crop.pixels.data(), 1));
}

std::vector<KindPrediction> LibraryPrior::Predict(const core::Image& crop,
                                                  const std::vector<int>& kinds) const {
  const torch::NoGradGuard no_grad;
  const torch::Tensor picture = LibraryPictures(crop.pixels.data(), 1);
  const torch::Tensor features = network_->net->Features(picture);
  const std::vector<double> all = network_->KindsOf(picture);
  std::vector<KindPrediction> predictions;
  for (const int kind : kinds) {
    const LibraryNetworkOutput out =
        network_->net->Parameters(features, torch::full({1}, kind, torch::kLong));
    KindPrediction one;
    one.kind = kind;
    one.probability = all[static_cast<size_t>(kind)];
    one.azimuth = VectorOf(torch::softmax(out.azimuth, 1));
    const torch::Tensor choices = torch::softmax(out.choices, 2);
    for (int i = 0; i < kPriorDraws; ++i) {
      one.choices.push_back(VectorOf(choices.select(1, i)));
    }
    one.opening = VectorOf(choices.select(1, kPriorDraws));
    const std::vector<double> numbers = VectorOf(out.numbers);
    for (size_t i = 0; i < 5; ++i) {
      const double scale = i == 4 ? 0.1 : 1.0;
      one.numbers[i] = scale * numbers[i];
      one.errors[i] = scale * std::exp(std::clamp(numbers[5 + i], -4.0, 2.0));
    }
    predictions.push_back(std::move(one));
  }
  return predictions;
}

}  // namespace simwright::library_fit
