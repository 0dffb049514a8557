#include <algorithm>
#include <cmath>

#include "asset_lift/priors/prior_training.h"
#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_network.h"
#include "asset_lift/priors/shape_prior.h"
#include "asset_lift/priors/training_loop.h"
#include "asset_lift/priors/view_network.h"
#include "core/error.h"
#include "core/parallel.h"
#include "nn/compute.h"
#include "nn/diffusion_schedule.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

// The number of other views per photo: the shape prior's prediction is reused for them.
constexpr int kViewsPerPhoto = 4;
// The share of images without conditioning, as classifier-free guidance requires.
constexpr double kUnconditionedShare = 0.1;
// The elevation range of ScoreDistillationOptions.
constexpr double kElevationMin = -0.17, kElevationMax = 1.4;  // rad

struct ViewBatch {
  torch::Tensor clean;     // (B x 4 x S x S)
  torch::Tensor rendered;  // (B x 5 x S x S)
  torch::Tensor taken;     // (B x 4 x S x S)
  torch::Tensor camera;    // (B x 5)
};

core::Image RgbaImage(const std::vector<std::uint8_t>& pixels) {
  core::Image image(kCropSide, kCropSide, 4);
  image.pixels = pixels;
  return image;
}

// Renders the object like a fit, from another camera in the same light.
ObjectImage TrueView(const TrainingObject& object, const core::Camera& camera,
                     const render::SphericalHarmonicsLight& light) {
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.light = light;
  const core::Image color = render::RenderForward(object.scene(), camera, options).color;
  ObjectImage picture{core::FloatImage(camera.width, camera.height, 3),
                      core::FloatImage(camera.width, camera.height, 1)};
  for (size_t i = 0; i < picture.opacity.values.size(); ++i) {
    const float alpha = static_cast<float>(color.pixels[4 * i + 3]) / 255.0f;
    picture.opacity.values[i] = alpha;
    for (size_t c = 0; c < 3; ++c) {
      picture.color.values[3 * i + c] =
          alpha * static_cast<float>(color.pixels[4 * i + c]) / 255.0f;
    }
  }
  return picture;
}

ViewBatch SampleViews(const TrainingPool& pool, const ShapePrior& shape, int size,
                      std::uint64_t seed, std::uint64_t step) {
  const int photos = std::max(1, size / kViewsPerPhoto);
  std::vector<ShapeExample> examples(static_cast<size_t>(photos));
  std::vector<const TrainingObject*> objects(static_cast<size_t>(photos));
  core::ParallelFor(photos, [&](int i) {
    core::Rng rng = core::StreamRng(seed ^ 0x71e3ull, step * 4096 + static_cast<std::uint64_t>(i));
    objects[static_cast<size_t>(i)] =
        &pool.object(static_cast<int>(core::UniformIndex(rng, pool.size())));
    examples[static_cast<size_t>(i)] = MakeShapeExample(*objects[static_cast<size_t>(i)], &rng);
  });
  std::vector<core::Image> crops;
  std::vector<ViewFrame> frames;
  for (const ShapeExample& example : examples) {
    crops.push_back(RgbaImage(example.picture));
    frames.push_back(example.frame);
  }
  const std::vector<ShapePrediction> predictions = shape.Predict(crops, frames);
  const auto views = static_cast<size_t>(photos) * kViewsPerPhoto;
  std::vector<torch::Tensor> clean(views), rendered(views), taken(views), camera(views);
  core::ParallelFor(static_cast<int>(views), [&](int i) {
    const auto at = static_cast<size_t>(i), photo = at / kViewsPerPhoto;
    core::Rng rng =
        core::StreamRng(seed ^ 0x0c0ffeeull, step * 4096 + static_cast<std::uint64_t>(i));
    const core::Camera from =
        RandomCameraAround(frames[photo], kElevationMin, kElevationMax, kViewSide, &rng);
    clean[at] = PictureTensor(TrueView(*objects[photo], from, examples[photo].light));
    const bool blind = core::Uniform(rng) < kUnconditionedShare;
    camera[at] = CameraTensor(frames[photo].camera, from);
    rendered[at] = blind ? torch::zeros({1, 5, kViewSide, kViewSide})
                         : PredictionTensor(RenderPrediction(predictions[photo], from), from,
                                            frames[photo].Radius());
    taken[at] = blind ? torch::zeros({1, 4, kCropSide, kCropSide})
                      : PicturesFromRgba(examples[photo].picture.data(), 1, kCropSide);
  });
  return {torch::cat(clean), torch::cat(rendered), torch::cat(taken), torch::cat(camera)};
}

// Returns the network's mean squared error of the noise. Its metrics, in the noisy image's scale,
// are the squared error of the clean image that follows from it, and that of the shape prior's
// rendering used as the clean image.
PriorLoss DenoisingLoss(ViewNetwork network, const nn::DiffusionSchedule& schedule,
                        const ViewBatch& batch) {
  const torch::Tensor t = torch::randint(0, schedule.steps(), {batch.clean.size(0)},
                                         batch.clean.options().dtype(torch::kLong));
  const torch::Tensor noise = torch::randn_like(batch.clean);
  const torch::Tensor noisy = schedule.AddNoise(batch.clean, noise, t);
  const torch::Tensor off = network(noisy, batch.rendered, batch.taken, batch.camera, t) - noise;
  const torch::Tensor rendered_off = batch.rendered.slice(1, 0, 4) - batch.clean;
  return {off.square().mean(),
          {(schedule.Noise(t) * off).square().mean().item<double>(),
           (schedule.Signal(t) * rendered_off).square().mean().item<double>()}};
}

}  // namespace

PriorTrainingReport TrainViewNetwork(const std::vector<core::TexturedMesh>& meshes,
                                     const std::filesystem::path& shape_weights,
                                     const PriorTrainingOptions& options,
                                     const std::filesystem::path& weights, core::Progress* progress,
                                     const PriorTrainingListener& report) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "prior training");
  nn::PrepareForWork();
  torch::manual_seed(options.seed);
  const torch::Device device = nn::BestDevice();
  const ShapePrior shape(shape_weights);
  ViewNetwork network;
  network->to(device);
  ViewNetwork kept;
  const nn::DiffusionSchedule schedule = nn::DiffusionSchedule::Cosine(kViewDiffusionSteps);
  const PriorTraining training{
      "view", {"picture error", "picture error of the drawing"}, 77, network.get(), kept.get(), {}};
  return TrainPrior(training, meshes, options, weights, progress, report,
                    [&](const TrainingPool& pool, int step) -> PriorBatch {
                      const ViewBatch sampled =
                          SampleViews(pool, shape, options.batch, options.seed,
                                      static_cast<std::uint64_t>(step));
                      return [&network, &schedule, device, sampled] {
                        return DenoisingLoss(network, schedule,
                                             {sampled.clean.to(device), sampled.rendered.to(device),
                                              sampled.taken.to(device), sampled.camera.to(device)});
                      };
                    });
}

}  // namespace simwright::asset_lift
