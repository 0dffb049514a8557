#include "scene/metrics/feature_training.h"

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "scene/metrics/feature_network.h"

namespace simwright::scene {
namespace {

using torch::indexing::Slice;

// Images of a step, and their counts (B x kMaxLabels x kCountsPerClass).
struct Batch {
  torch::Tensor pictures, counts;
};

Batch BatchOf(const std::vector<CountedPicture>& pictures, const std::vector<size_t>& chosen) {
  std::vector<core::Image> images;
  std::vector<float> counts;
  for (const size_t i : chosen) {
    images.push_back(pictures[i].picture);
    counts.insert(counts.end(), pictures[i].counts.begin(), pictures[i].counts.end());
  }
  return {PictureTensor(images), torch::tensor(counts).view({-1, kMaxLabels, kCountsPerClass})};
}

// Mirrors all images of the batch and permutes the quadrants of their counts.
void Mirror(bool sideways, bool upside_down, Batch* batch) {
  std::vector<std::int64_t> quarters = {0, 1, 2, 3, 4};
  if (sideways) {
    batch->pictures = batch->pictures.flip({3});
    quarters = {0, 2, 1, 4, 3};
  }
  if (upside_down) {
    batch->pictures = batch->pictures.flip({2});
    for (std::int64_t& quarter : quarters) {
      if (quarter > 0) quarter = (quarter + 1) % 4 + 1;
    }
  }
  batch->counts = batch->counts.index_select(2, torch::tensor(quarters));
}

std::vector<size_t> Range(size_t from, size_t to) {
  std::vector<size_t> indices;
  for (size_t i = from; i < to; ++i) indices.push_back(i);
  return indices;
}

// Evaluates the predicted totals on the held-out images.
void Evaluate(FeatureNetwork network, const std::vector<CountedPicture>& pictures, int training,
              torch::Device device, FeatureTrainingReport* report) {
  const torch::NoGradGuard no_gradient;
  torch::Tensor mean = torch::zeros({kMaxLabels});
  for (int i = 0; i < training; ++i) {
    mean += torch::tensor(pictures[static_cast<size_t>(i)].counts)
                .view({kMaxLabels, kCountsPerClass})
                .index({Slice(), 0});
  }
  mean /= training;
  const Batch held_out = BatchOf(pictures, Range(static_cast<size_t>(training), pictures.size()));
  const torch::Tensor truth = held_out.counts.index({Slice(), Slice(), 0});
  const torch::Tensor predicted = torch::expm1(
      network->forward(held_out.pictures.to(device)).to(torch::kCPU).index({Slice(), Slice(), 0}));
  const torch::Tensor present = (truth.sum(0) > 0).nonzero().squeeze(1);
  const auto error = [&](const torch::Tensor& prediction) {
    return (prediction - truth).abs().index_select(1, present).mean().item<double>();
  };
  report->error = error(predicted);
  report->error_of_the_mean = error(mean.expand_as(truth));
}

void RequireTrainable(const std::vector<CountedPicture>& pictures) {
  if (pictures.size() < 10) throw core::Error("features need at least 10 images to train on");
  for (const CountedPicture& one : pictures) {
    if (one.counts.size() != static_cast<size_t>(kMaxLabels * kCountsPerClass) ||
        one.picture.width != kFeatureWidth || one.picture.height != kFeatureHeight) {
      throw core::Error("an image does not have the size that features are trained on");
    }
  }
}

}  // namespace

CountedPicture CountPicture(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                            const AssetSet& asset_set, const core::Camera& camera) {
  CountedPicture counted;
  counted.picture = core::Resize(LabelRender(objects, vocabulary, asset_set, camera), kFeatureWidth,
                                 kFeatureHeight);
  counted.counts.assign(static_cast<size_t>(kMaxLabels * kCountsPerClass), 0.0f);
  for (const SceneObject& object : objects) {
    float* const counts =
        &counted.counts[static_cast<size_t>(vocabulary.ClassOf(object.category) * kCountsPerClass)];
    counts[0] += 1.0f;
    const Eigen::Vector3d seen = camera.Project(object.world_from_object.translation());
    const bool inside = seen.z() > 0.0 && seen.x() >= 0.0 && seen.x() < camera.width &&
                        seen.y() >= 0.0 && seen.y() < camera.height;
    if (!inside) continue;
    counts[1 + (seen.x() >= 0.5 * camera.width) + 2 * (seen.y() >= 0.5 * camera.height)] += 1.0f;
  }
  return counted;
}

FeatureTrainingOptions::FeatureTrainingOptions() {
  trainer.steps = 1500;
  trainer.learning_rate = 2e-3;
  trainer.ema_decay = 0.99;
  trainer.save_every = 1 << 30;  // never: training takes minutes only
}

bool FeatureTrainingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!trainer.IsValid(error)) return false;
  if (batch < 1) return fails("batch must be at least 1");
  if (!(held_out > 0.0 && held_out < 1.0)) return fails("held_out must be a share above 0");
  return true;
}

FeatureTrainingReport TrainFeatures(const std::vector<CountedPicture>& pictures,
                                    const FeatureTrainingOptions& options,
                                    const std::filesystem::path& weights,
                                    core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("training of features: " + error);
  RequireTrainable(pictures);
  nn::PrepareForWork();
  const auto start = std::chrono::steady_clock::now();
  FeatureTrainingReport report;
  report.held_out =
      std::max(1, static_cast<int>(options.held_out * static_cast<double>(pictures.size())));
  report.pictures = static_cast<int>(pictures.size()) - report.held_out;
  torch::manual_seed(options.seed);
  const torch::Device device = nn::BestDevice();
  FeatureNetwork network;
  network->to(device);
  for (const torch::Tensor& one : network->parameters()) report.parameters += one.numel();
  nn::Trainer trainer(network.ptr().get(), options.trainer, weights.string() + ".training");
  core::Rng rng = core::StreamRng(options.seed, 0);
  progress->Stage("learning features", options.trainer.steps);
  for (int step = 0; step < options.trainer.steps; ++step) {
    std::vector<size_t> chosen;
    for (int i = 0; i < options.batch; ++i) {
      chosen.push_back(static_cast<size_t>(core::UniformIndex(rng, report.pictures)));
    }
    Batch batch = BatchOf(pictures, chosen);
    const bool sideways = core::Uniform(rng) < 0.5, upside_down = core::Uniform(rng) < 0.5;
    Mirror(sideways, upside_down, &batch);
    const torch::Tensor predicted = network->forward(batch.pictures.to(device));
    trainer.Step(step, torch::mse_loss(predicted, batch.counts.to(device).log1p()));
    progress->Advance();
  }
  trainer.CopyAverageTo(network.ptr().get());
  network->eval();
  Evaluate(network, pictures, report.pictures, device, &report);
  network->to(torch::kCPU);
  nn::SaveCheckpoint(*network, {{"kind", kFeatureKind}}, weights);
  trainer.Finish();
  progress->Finish();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace simwright::scene
