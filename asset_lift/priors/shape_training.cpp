#include <cmath>

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

torch::Tensor Bytes(std::vector<std::uint8_t>* values, at::IntArrayRef shape) {
  return torch::from_blob(values->data(), shape, torch::kUInt8).to(torch::kFloat).div(255.0);
}

// Samples photos of random objects of the pool. A mirrored photo is a photo of a mirrored object.
Batch SampleBatch(const TrainingPool& pool, int size, std::uint64_t seed, std::uint64_t step) {
  std::vector<ShapeExample> examples(static_cast<size_t>(size));
  std::vector<std::uint8_t> mirrored(static_cast<size_t>(size));
  core::ParallelFor(size, [&](int i) {
    core::Rng rng =
        core::StreamRng(seed ^ 0x51a9e5ull, step * 4096 + static_cast<std::uint64_t>(i));
    const TrainingObject& object =
        pool.object(static_cast<int>(core::UniformIndex(rng, pool.size())));
    examples[static_cast<size_t>(i)] = MakeShapeExample(object, &rng);
    mirrored[static_cast<size_t>(i)] = core::Uniform(rng) < 0.5;
  });
  std::vector<torch::Tensor> pictures, occupancy, back;
  std::vector<float> elevation;
  for (size_t i = 0; i < examples.size(); ++i) {
    ShapeExample& e = examples[i];
    torch::Tensor picture = PicturesFromRgba(e.picture.data(), 1, kCropSide)[0];
    torch::Tensor volume = Bytes(&e.occupancy, {kDepthCells, kCropSide, kCropSide});
    torch::Tensor behind = Bytes(&e.back, {kCropSide, kCropSide, 3}).permute({2, 0, 1});
    if (mirrored[i]) {
      picture = picture.flip(2);
      volume = volume.flip(2);
      behind = behind.flip(2);
    }
    pictures.push_back(picture);
    occupancy.push_back(volume);
    back.push_back(behind);
    elevation.push_back(static_cast<float>(e.elevation));
  }
  return {torch::stack(pictures), torch::stack(occupancy), torch::stack(back),
          torch::tensor(elevation)};
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
  const PriorTraining training{"shape",    {"volume IoU", "elevation error, deg"},
                               0,          network.get(),
                               kept.get(), sizes.Metadata()};
  return TrainPrior(training, meshes, options, weights, progress, report,
                    [&](const TrainingPool& pool, int step) -> PriorBatch {
                      const Batch sampled = SampleBatch(pool, options.batch, options.seed,
                                                        static_cast<std::uint64_t>(step));
                      return [&network, device, sampled] {
                        const Batch batch{sampled.pictures.to(device), sampled.occupancy.to(device),
                                          sampled.back.to(device), sampled.elevation.to(device)};
                        const Losses losses = LossesOf(network(batch.pictures), batch);
                        return PriorLoss{losses.total, {losses.iou, losses.elevation_error}};
                      };
                    });
}

}  // namespace simwright::asset_lift
