#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset_lift/priors/prior_training.h"
#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_network.h"
#include "asset_lift/priors/training_loop.h"
#include "core/error.h"
#include "core/parallel.h"
#include "nn/compute.h"

namespace simwright::asset_lift {
namespace {

struct Batch {
  torch::Tensor pictures;   // (B x 4 x S x S)
  torch::Tensor occupancy;  // (B x D x S x S)
  torch::Tensor back;       // (B x 3 x S x S)
  torch::Tensor elevation;  // (B)
};

torch::Tensor BytesOf(std::vector<std::uint8_t>* values, at::IntArrayRef shape) {
  return torch::from_blob(values->data(), shape, torch::kUInt8);
}

// The photos that a step trains on: newly rendered ones, and earlier ones that are kept in memory.
class ShapeBatches {
 public:
  explicit ShapeBatches(const PriorTrainingOptions& options) : options_(options) {}

  // Renders the new photos of a step from random objects of the pool, and draws the step's batch.
  // All values are bytes.
  Batch Draw(const TrainingPool& pool, std::uint64_t step) {
    const int fresh = options_.fresh > 0 ? options_.fresh : options_.batch;
    std::vector<ShapeExample> rendered(static_cast<size_t>(fresh));
    core::ParallelFor(fresh, [&](int i) {
      core::Rng rng =
          core::StreamRng(options_.seed ^ 0x51a9e5ull, step * 4096 + static_cast<std::uint64_t>(i));
      const TrainingObject& object =
          pool.object(static_cast<int>(core::UniformIndex(rng, pool.size())));
      rendered[static_cast<size_t>(i)] = MakeShapeExample(object, &rng);
    });
    if (fresh == options_.batch) return BatchOf(&rendered, Range(fresh));
    for (ShapeExample& example : rendered) {
      if (memory_.size() < static_cast<size_t>(options_.memory)) {
        memory_.push_back(std::move(example));
      } else {
        memory_[static_cast<size_t>(made_) % memory_.size()] = std::move(example);
      }
      ++made_;
    }
    core::Rng rng = core::StreamRng(options_.seed ^ 0x3e307ull, step);
    std::vector<size_t> chosen(static_cast<size_t>(options_.batch));
    for (size_t& at : chosen) {
      at = static_cast<size_t>(core::UniformIndex(rng, static_cast<std::int64_t>(memory_.size())));
    }
    return BatchOf(&memory_, chosen);
  }

 private:
  static std::vector<size_t> Range(int count) {
    std::vector<size_t> indices(static_cast<size_t>(count));
    std::iota(indices.begin(), indices.end(), size_t{0});
    return indices;
  }

  static Batch BatchOf(std::vector<ShapeExample>* examples, const std::vector<size_t>& chosen) {
    std::vector<torch::Tensor> pictures, occupancy, back;
    std::vector<float> elevation;
    for (const size_t at : chosen) {
      ShapeExample& e = (*examples)[at];
      pictures.push_back(BytesOf(&e.picture, {kCropSide, kCropSide, 4}));
      occupancy.push_back(BytesOf(&e.occupancy, {kDepthCells, kCropSide, kCropSide}));
      back.push_back(BytesOf(&e.back, {kCropSide, kCropSide, 3}).permute({2, 0, 1}));
      elevation.push_back(static_cast<float>(e.elevation));
    }
    return {torch::stack(pictures), torch::stack(occupancy), torch::stack(back),
            torch::tensor(elevation)};
  }

  const PriorTrainingOptions options_;
  std::vector<ShapeExample> memory_;
  std::int64_t made_ = 0;
};

// Returns a batch of bytes as numbers on the device, a half of it mirrored: a mirrored photo is a
// photo of a mirrored object.
Batch NumbersOn(const torch::Device& device, const Batch& bytes) {
  const auto numbers = [&](const torch::Tensor& t) {
    return t.to(device).to(torch::kFloat).div(255.0);
  };
  const torch::Tensor turned =
      torch::rand({bytes.elevation.size(0), 1, 1, 1}, torch::TensorOptions(device)) < 0.5;
  const auto mirrored = [&](const torch::Tensor& t) { return torch::where(turned, t.flip(3), t); };
  const torch::Tensor rgba = numbers(bytes.pictures).permute({0, 3, 1, 2});
  const torch::Tensor alpha = rgba.slice(1, 3, 4);
  const torch::Tensor pictures = torch::cat({(2.0 * rgba.slice(1, 0, 3) - 1.0) * alpha, alpha}, 1);
  return {mirrored(pictures).contiguous(), mirrored(numbers(bytes.occupancy)),
          mirrored(numbers(bytes.back)), bytes.elevation.to(device)};
}

struct Losses {
  torch::Tensor total;
  double iou = 0.0;
  double elevation_error = 0.0;  // degrees
};

// Computes the losses: cross-entropy and Dice of the volume where the silhouette permits occupancy,
// L1 of the hidden side's colour, and the Laplace likelihood of the elevation.
Losses LossesOf(const ShapeNetworkOutput& output, const Batch& batch) {
  // Columns outside the silhouette are certainly empty: they carry little information.
  const torch::Tensor seen = (batch.pictures.slice(1, 3, 4) > 0.02).to(torch::kFloat);
  const torch::Tensor weight = 0.05 + 0.95 * seen;
  const torch::Tensor entropy =
      (torch::binary_cross_entropy_with_logits(output.occupancy, batch.occupancy, {}, {},
                                               at::Reduction::None) *
       weight)
          .sum() /
      (weight.sum() * kDepthCells);
  const torch::Tensor share = torch::sigmoid(output.occupancy) * seen;
  const torch::Tensor both = (share * batch.occupancy).sum({1, 2, 3});
  const torch::Tensor dice =
      1.0 - (2.0 * both + 1.0) / (share.sum({1, 2, 3}) + batch.occupancy.sum({1, 2, 3}) + 1.0);
  const torch::Tensor color = ((output.back - batch.back).abs() * seen).sum() / (3.0 * seen.sum());
  const torch::Tensor off = (output.elevation.select(1, 0) - batch.elevation).abs();
  const torch::Tensor log_b = torch::clamp(output.elevation.select(1, 1), -4.0, 1.0);
  const torch::Tensor likelihood = (off * torch::exp(-log_b) + log_b).mean();
  Losses losses;
  losses.total = entropy + 0.5 * dice.mean() + 0.3 * color + 0.03 * likelihood;
  const torch::NoGradGuard no_grad;
  const torch::Tensor ours = (output.occupancy > 0.0) & (seen > 0.5), truth = batch.occupancy > 0.5;
  losses.iou = ((ours & truth).sum({1, 2, 3}).to(torch::kFloat) /
                torch::clamp_min((ours | truth).sum({1, 2, 3}).to(torch::kFloat), 1.0))
                   .mean()
                   .item<double>();
  losses.elevation_error = off.mean().item<double>() * 180.0 / M_PI;
  return losses;
}

}  // namespace

PriorTrainingReport TrainShapeNetwork(const std::vector<core::TexturedMesh>& meshes,
                                      const PriorTrainingOptions& options,
                                      const std::filesystem::path& weights,
                                      core::Progress* progress,
                                      const PriorTrainingListener& report) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "prior training");
  nn::PrepareForWork();
  torch::manual_seed(options.seed);
  const torch::Device device = nn::BestDevice();
  ShapeNetworkOptions sizes;
  sizes.channels = options.shape_channels;
  ShapeNetwork network(sizes);
  network->to(device);
  ShapeNetwork kept(sizes);
  const PriorTraining training{
      "shape",          {"volume IoU", "elevation error, deg"}, 0, network.get(), kept.get(),
      sizes.Metadata(), nn::StoredPrecision::kEightBits};
  ShapeBatches batches(options);
  return TrainPrior(training, meshes, options, weights, progress, report,
                    [&](const TrainingPool& pool, int step) -> PriorBatch {
                      const Batch drawn = batches.Draw(pool, static_cast<std::uint64_t>(step));
                      return [&network, device, drawn] {
                        const Batch batch = NumbersOn(device, drawn);
                        const Losses losses = LossesOf(network(batch.pictures), batch);
                        return PriorLoss{losses.total, {losses.iou, losses.elevation_error}};
                      };
                    });
}

}  // namespace simwright::asset_lift
