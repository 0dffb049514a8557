#include "scene/metrics/classifier_accuracy.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/error.h"
#include "core/shuffle.h"
#include "nn/compute.h"
#include "nn/torch.h"

namespace simwright::scene {
namespace {

torch::Tensor TensorOf(const FeatureMatrix& features) {
  return torch::from_blob(const_cast<float*>(features.data()), {features.rows(), features.cols()})
      .clone();
}

torch::Tensor Shuffled(std::int64_t count, core::Rng& rng) {
  std::vector<std::int64_t> order(static_cast<size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  core::Shuffle(&order, rng);
  return torch::tensor(order);
}

struct Halves {
  torch::Tensor train, train_labels, test, test_labels;
};

// Splits both sets in halves of equal size, so that guessing is right in 50 of 100.
Halves Split(const torch::Tensor& data, const torch::Tensor& generated, bool standardise,
             core::Rng& rng) {
  const std::int64_t count = std::min(data.size(0), generated.size(0)), half = count / 2;
  const torch::Tensor a = data.index_select(0, Shuffled(data.size(0), rng));
  const torch::Tensor b = generated.index_select(0, Shuffled(generated.size(0), rng));
  const auto labels = [](std::int64_t n) {
    return torch::cat({torch::zeros({n}), torch::ones({n})});
  };
  Halves halves;
  halves.train = torch::cat({a.slice(0, 0, half), b.slice(0, 0, half)});
  halves.test = torch::cat({a.slice(0, half, count), b.slice(0, half, count)});
  halves.train_labels = labels(half);
  halves.test_labels = labels(count - half);
  if (standardise) {
    const torch::Tensor mean = halves.train.mean(0, true);
    const torch::Tensor deviation = halves.train.std(0, true, true).clamp_min(1e-6);
    halves.train = (halves.train - mean) / deviation;
    halves.test = (halves.test - mean) / deviation;
  }
  return halves;
}

double Percent(torch::nn::Linear& linear, const Halves& halves) {
  const torch::NoGradGuard no_gradient;
  const torch::Tensor logits = linear->forward(halves.test).squeeze(1);
  // A logit of exactly zero counts half.
  const torch::Tensor right =
      torch::where(logits == 0.0, torch::full_like(logits, 0.5),
                   ((logits > 0.0) == (halves.test_labels > 0.5)).to(torch::kFloat32));
  const double percent = 100.0 * right.mean().item<double>();
  return std::max(percent, 100.0 - percent);
}

std::vector<double> Run(const Halves& halves, const AccuracyOptions& options, core::Rng& rng) {
  torch::nn::Linear linear(halves.train.size(1), 1);
  // Starts from zero, so that a random start does not dominate a few small steps.
  torch::nn::init::zeros_(linear->weight);
  torch::nn::init::zeros_(linear->bias);
  torch::optim::Adam optimizer(linear->parameters(),
                               torch::optim::AdamOptions(options.learning_rate));
  std::vector<double> scores;
  for (int pass = 1; pass <= options.scored_epochs.back(); ++pass) {
    const torch::Tensor order = Shuffled(halves.train.size(0), rng);
    for (const torch::Tensor& batch : order.split(options.batch)) {
      optimizer.zero_grad();
      torch::nn::functional::binary_cross_entropy_with_logits(
          linear->forward(halves.train.index_select(0, batch)).squeeze(1),
          halves.train_labels.index_select(0, batch))
          .backward();
      optimizer.step();
    }
    if (std::binary_search(options.scored_epochs.begin(), options.scored_epochs.end(), pass)) {
      scores.push_back(Percent(linear, halves));
    }
  }
  return scores;
}

void RequireSamples(const FeatureMatrix& data, const FeatureMatrix& generated) {
  if (data.cols() != generated.cols() || data.cols() == 0) {
    throw core::Error("a classifier needs features of one size");
  }
  if (std::min(data.rows(), generated.rows()) < 4) {
    throw core::Error("a classifier needs at least 4 scenes of each set");
  }
  if (!data.allFinite() || !generated.allFinite()) {
    throw core::Error("the features of an image are not finite");
  }
}

}  // namespace

bool AccuracyOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (runs < 1) return fails("runs must be at least 1");
  if (scored_epochs.empty() || scored_epochs.front() < 1)
    return fails("scored_epochs must name passes, at least 1");
  if (std::adjacent_find(scored_epochs.begin(), scored_epochs.end(), std::greater_equal<int>()) !=
      scored_epochs.end()) {
    return fails("scored_epochs must ascend");
  }
  if (!(learning_rate > 0.0 && std::isfinite(learning_rate))) {
    return fails("learning_rate must be above 0");
  }
  if (batch < 1) return fails("batch must be at least 1");
  return true;
}

std::vector<AccuracyScore> ClassifierAccuracy(const FeatureMatrix& data,
                                              const FeatureMatrix& generated,
                                              const AccuracyOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("classifier: " + error);
  RequireSamples(data, generated);
  nn::PrepareForWork();
  const torch::Tensor a = TensorOf(data), b = TensorOf(generated);
  std::vector<AccuracyScore> scores(options.scored_epochs.size());
  for (size_t i = 0; i < scores.size(); ++i) scores[i].passes = options.scored_epochs[i];
  std::vector<double> squares(scores.size(), 0.0);
  for (int run = 0; run < options.runs; ++run) {
    core::Rng rng = core::StreamRng(options.seed, static_cast<std::uint64_t>(run));
    const std::vector<double> percents = Run(Split(a, b, options.standardise, rng), options, rng);
    for (size_t i = 0; i < scores.size(); ++i) {
      scores[i].percent += percents[i] / options.runs;
      squares[i] += percents[i] * percents[i] / options.runs;
    }
  }
  for (size_t i = 0; i < scores.size(); ++i) {
    scores[i].deviation =
        std::sqrt(std::max(0.0, squares[i] - scores[i].percent * scores[i].percent));
  }
  return scores;
}

}  // namespace simwright::scene
