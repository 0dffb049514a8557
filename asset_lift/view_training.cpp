#include <algorithm>
#include <cmath>

#include "asset_lift/prior_training.h"
#include "asset_lift/shape_example.h"
#include "asset_lift/shape_network.h"
#include "asset_lift/shape_prior.h"
#include "asset_lift/training_means.h"
#include "asset_lift/training_pool.h"
#include "asset_lift/view_network.h"
#include "core/error.h"
#include "core/parallel.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

// Other views asked for of one photo: the shape prior's answer is used as often.
constexpr int kViewsAPhoto = 4;
// Of the pictures no condition is told, so that guidance has something to lead away from.
constexpr double kBlindShare = 0.1;

struct ViewBatch {
  torch::Tensor clean;   // (B x 4 x S x S)
  torch::Tensor drawn;   // (B x 5 x S x S)
  torch::Tensor taken;   // (B x 4 x S x S)
  torch::Tensor camera;  // (B x 5)
};

core::Image RgbaImage(const std::vector<std::uint8_t>& pixels) {
  core::Image image(kCropSide, kCropSide, 4);
  image.pixels = pixels;
  return image;
}

// The object as a fit would show it, from another camera in the same light.
ObjectPicture TrueView(const TrainingObject& object, const core::Camera& camera,
                       const render::SphericalHarmonicsLight& light) {
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.light = light;
  const core::Image color = render::RenderForward(object.scene(), camera, options).color;
  ObjectPicture picture{core::FloatImage(camera.width, camera.height, 3),
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

// As score distillation asks for them (ScoreDistillation::NextCamera).
core::Camera OtherCamera(const ViewFrame& frame, core::Rng* rng) {
  const double elevation = std::asin(core::Uniform(*rng, std::sin(-0.17), std::sin(1.4)));
  const double azimuth = core::Uniform(*rng, 0.0, 2.0 * M_PI);
  const double fov = 2.0 * std::atan(1.25 * frame.half / frame.camera.fx);
  return core::OrbitCamera(Eigen::Vector3d::Zero(), frame.camera.position().norm(), elevation,
                           azimuth, fov, kViewSide, kViewSide);
}

ViewBatch DrawViews(const TrainingPool& pool, const ShapePrior& shape, int size, std::uint64_t seed,
                    std::uint64_t step) {
  const int photos = std::max(1, size / kViewsAPhoto);
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
  const auto views = static_cast<size_t>(photos) * kViewsAPhoto;
  std::vector<torch::Tensor> clean(views), drawn(views), taken(views), camera(views);
  core::ParallelFor(static_cast<int>(views), [&](int i) {
    const auto at = static_cast<size_t>(i), photo = at / kViewsAPhoto;
    core::Rng rng =
        core::StreamRng(seed ^ 0x0c0ffeeull, step * 4096 + static_cast<std::uint64_t>(i));
    const core::Camera from = OtherCamera(frames[photo], &rng);
    clean[at] = PictureTensor(TrueView(*objects[photo], from, examples[photo].light));
    const bool blind = core::Uniform(rng) < kBlindShare;
    camera[at] = CameraTensor(frames[photo].camera, from);
    drawn[at] =
        blind ? torch::zeros({1, 5, kViewSide, kViewSide})
              : DrawnTensor(DrawPrediction(predictions[photo], from), from, frames[photo].Radius());
    taken[at] = blind ? torch::zeros({1, 4, kCropSide, kCropSide})
                      : PicturesFromRgba(examples[photo].picture.data(), 1, kCropSide);
  });
  return {torch::cat(clean), torch::cat(drawn), torch::cat(taken), torch::cat(camera)};
}

}  // namespace

PriorTrainingReport TrainViewNetwork(const std::vector<core::TexturedMesh>& meshes,
                                     const std::filesystem::path& shape_weights,
                                     const PriorTrainingOptions& options,
                                     const std::filesystem::path& weights, core::Progress* progress,
                                     const PriorTrainingListener& report) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "prior training");
  nn::UseThreads();
  torch::manual_seed(options.seed);
  const torch::Device device = nn::BestDevice();
  const ShapePrior shape(shape_weights);
  ViewNetwork network;
  network->to(device);
  nn::Trainer trainer(network.get(), options.trainer, weights.string() + ".state");
  progress->Stage("preparing shapes");
  TrainingPool pool(
      &meshes, options.pool, options.parametric_share,
      options.seed + 77 + 1000003ull * static_cast<std::uint64_t>(trainer.first_step()));
  const nn::DiffusionSchedule schedule = nn::DiffusionSchedule::Cosine(kViewDiffusionSteps);
  const int steps = options.trainer.steps;
  progress->Stage("view prior", steps - trainer.first_step());
  TrainingMeans means({"noise error", "noise error of the drawing"}, steps, report);
  for (int step = trainer.first_step(); step < steps; ++step) {
    pool.Exchange(options.exchange);
    ViewBatch batch =
        DrawViews(pool, shape, options.batch, options.seed, static_cast<std::uint64_t>(step));
    const torch::Tensor clean = batch.clean.to(device), drawn = batch.drawn.to(device);
    const torch::Tensor t = torch::randint(0, schedule.steps(), {clean.size(0)},
                                           torch::TensorOptions(torch::kLong).device(device));
    const torch::Tensor noise = torch::randn_like(clean);
    const torch::Tensor noisy = schedule.AddNoise(clean, noise, t);
    const torch::Tensor guess =
        network(noisy, drawn, batch.taken.to(device), batch.camera.to(device), t);
    const torch::Tensor loss = torch::mse_loss(guess, noise);
    trainer.Descend(step, loss);
    const torch::Tensor plain =
        (noisy - schedule.Signal(t) * drawn.slice(1, 0, 4)) / schedule.Noise(t);
    const double of_drawing = torch::mse_loss(plain, noise).item<double>();
    means.Add(step, loss.item<double>(), {loss.item<double>(), of_drawing});
    if (trainer.SaveDue(step)) {
      trainer.SaveState(step + 1);
      ViewNetwork kept;
      trainer.CopyAverageTo(kept.get());
      nn::SaveCheckpoint(*kept,
                         {{"kind", "view"},
                          {"step", std::to_string(step + 1)},
                          {"batch", std::to_string(options.batch)},
                          {"seed", std::to_string(options.seed)},
                          {"meshes", std::to_string(meshes.size())}},
                         weights);
    }
    progress->Advance();
  }
  progress->Finish();
  trainer.Finish();
  return means.last();
}

}  // namespace simwright::asset_lift
