#include "twin/detector_training.h"

#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "twin/detector_batch.h"
#include "twin/detector_network.h"

namespace simwright::twin {
namespace {

constexpr int kReportSteps = 50;
constexpr double kDegreesInRadian = 180.0 / M_PI;

// The pictures of a training, exchanged gradually, since rendering one takes about as long as a
// step on it.
class TablePool {
 public:
  TablePool(const TableSceneSources& sources, const DetectorTrainingOptions& options,
            std::uint64_t seed, const std::function<void()>& done)
      : sources_(sources),
        options_(options),
        seed_(seed),
        examples_(static_cast<size_t>(options.pool)) {
    constexpr int kShares = 100;
    for (int share = 0; share < kShares; ++share) {
      const int first = options.pool * share / kShares;
      const int last = options.pool * (share + 1) / kShares;
      core::ParallelFor(last - first, [&](int i) {
        examples_[static_cast<size_t>(first + i)] = Make(static_cast<std::uint64_t>(first + i));
      });
      done();
    }
    made_ = static_cast<std::uint64_t>(options.pool);
  }

  // Renders the next pictures without changing the pool; may run in another thread.
  std::vector<DetectorExample> Render(int count) const {
    std::vector<DetectorExample> examples;
    for (int i = 0; i < count; ++i) examples.push_back(Make(made_ + static_cast<std::uint64_t>(i)));
    return examples;
  }

  void Exchange(std::vector<DetectorExample> examples) {
    for (DetectorExample& example : examples) {
      examples_[static_cast<size_t>(made_++ % examples_.size())] = std::move(example);
    }
  }

  const DetectorExample& Pick(core::Rng* rng) const {
    return examples_[static_cast<size_t>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(examples_.size())))];
  }

 private:
  DetectorExample Make(std::uint64_t number) const {
    core::Rng rng = core::StreamRng(seed_, number);
    return MakeDetectorExample(sources_, options_.scenes, rng());
  }

  const TableSceneSources& sources_;
  const DetectorTrainingOptions& options_;
  std::uint64_t seed_;
  std::uint64_t made_ = 0;
  std::vector<DetectorExample> examples_;
};

// The sums of a batch's figures over its pictures, pixels or objects.
struct DetectorSums {
  torch::Tensor loss;  // scalar: the sum over pictures
  double shared = 0.0, joint = 0.0, offset = 0.0, pixels = 0.0;
  double camera[kCameraNumbers] = {};
  double pictures = 0.0;

  void Add(const DetectorSums& other) {
    shared += other.shared;
    joint += other.joint;
    offset += other.offset;
    pixels += other.pixels;
    for (int k = 0; k < kCameraNumbers; ++k) camera[k] += other.camera[k];
    pictures += other.pictures;
  }
};

// The parts of the network are trained one after the other: the camera's looks at the objects that
// the other one finds.
enum class DetectorPart { kPixels, kCamera };

DetectorSums PixelLosses(DetectorNetworkImpl* network, const DetectorBatch& batch) {
  const DetectorOutput out = network->DetectPixels(batch.pictures);
  const auto per_picture = [](const torch::Tensor& t) { return t.flatten(1).mean(1).sum(); };
  const torch::Tensor log_in = torch::log_sigmoid(out.object);
  const torch::Tensor log_out = torch::log_sigmoid(-out.object);
  const torch::Tensor bce = -(batch.object * log_in + (1.0 - batch.object) * log_out) * batch.known;
  const torch::Tensor share = torch::sigmoid(out.object) * batch.known;
  const torch::Tensor both = (share * batch.object).flatten(1).sum(1);
  const torch::Tensor all = share.flatten(1).sum(1) + batch.object.flatten(1).sum(1);
  const torch::Tensor dice = (1.0 - (2.0 * both + 1.0) / (all + 1.0)).sum();
  const torch::Tensor heat = -(batch.centre * torch::log_sigmoid(out.centre) * 6.0 +
                               (1.0 - batch.centre) * torch::log_sigmoid(-out.centre));
  const torch::Tensor off = (out.offset - batch.offset).abs() * batch.object;
  const torch::Tensor offset =
      (off.flatten(1).sum(1) / (batch.object.flatten(1).sum(1) + 1.0)).sum();
  DetectorSums sums;
  sums.loss = 3.0 * per_picture(bce) + dice + 3.0 * per_picture(heat) + 0.5 * offset;
  const torch::NoGradGuard no_grad;
  const torch::Tensor found = (out.object > 0.0).to(torch::kFloat);
  sums.shared = (found * batch.object).sum().item<double>();
  sums.joint = torch::clamp_max(found + batch.object, 1.0).sum().item<double>();
  sums.offset = kOffsetUnit * off.sum().item<double>();
  sums.pixels = batch.object.sum().item<double>();
  return sums;
}

DetectorSums CameraLosses(DetectorNetworkImpl* network, const DetectorBatch& batch) {
  const DetectorOutput out = network->Detect(batch.pictures);
  const torch::Tensor off = (out.camera - batch.camera).abs();
  DetectorSums sums;
  sums.loss = (off * torch::exp(-out.log_b) + out.log_b).mean(1).sum();
  const torch::NoGradGuard no_grad;
  for (int k = 0; k < kCameraNumbers; ++k) {
    sums.camera[k] = off.select(1, k).sum().item<double>();
  }
  sums.pictures = static_cast<double>(off.size(0));
  return sums;
}

// Trains the parts of the network.
class DetectorTraining {
 public:
  DetectorTraining(const TableSceneSources& sources, const DetectorTrainingOptions& options,
                   const std::filesystem::path& weights, core::Progress* progress,
                   const asset_lift::PriorTrainingListener& listener)
      : sources_(sources),
        options_(options),
        weights_(weights),
        progress_(progress),
        listener_(listener),
        device_(nn::BestDevice()),
        network_(options.network),
        kept_(options.network) {
    network_->to(device_);
  }

  asset_lift::PriorTrainingReport Run() {
    nn::Trainer pixels(network_->pixel_part(), options_.trainer, weights_.string() + ".state");
    nn::Trainer camera(network_->camera_part(), options_.camera_trainer,
                       weights_.string() + ".camera.state");
    // A resumed training uses new pictures.
    const auto resumed = static_cast<std::uint64_t>(pixels.first_step() + camera.first_step());
    progress_->Stage("rendering pictures", 100);
    TablePool pool(sources_, options_, options_.seed + 1000003ull * resumed,
                   [this] { progress_->Advance(); });
    Train(DetectorPart::kPixels, options_.trainer.steps, &pixels, &pool);
    pixels.CopyAverageTo(network_->pixel_part());
    pixels.CopyAverageTo(kept_->pixel_part());
    Train(DetectorPart::kCamera, options_.camera_trainer.steps, &camera, &pool);
    progress_->Finish();
    pixels.Finish();
    camera.Finish();
    return last_;
  }

 private:
  void Train(DetectorPart part, int steps, nn::Trainer* trainer, TablePool* pool) {
    const bool is_camera = part == DetectorPart::kCamera;
    const int first = trainer->first_step();
    progress_->Stage(is_camera ? "camera of the detector" : "table detector", steps - first);
    const int shares = nn::ShareCount(device_, options_.batch);
    for (int i = first; i < steps; ++i) {
      auto rendered =
          std::async(std::launch::async, [&] { return pool->Render(options_.exchange); });
      const DetectorBatch batch = NextBatch(part, i, *pool);
      std::vector<DetectorSums> parts(static_cast<size_t>(shares));
      const double loss = trainer->Step(i, shares, [&](int share) {
        const nn::Share of = nn::ShareOf(options_.batch, shares, share);
        DetectorSums& sums = parts[static_cast<size_t>(share)];
        const DetectorBatch some = PartOfBatch(batch, of.first, of.count);
        sums = is_camera ? CameraLosses(network_.get(), some) : PixelLosses(network_.get(), some);
        return sums.loss / options_.batch;
      });
      for (const DetectorSums& sums : parts) sums_.Add(sums);
      loss_ += loss;
      ++counted_;
      if ((i + 1) % kReportSteps == 0 || i + 1 == steps) Report(part, i + 1);
      pool->Exchange(rendered.get());
      if (trainer->SaveDue(i)) Save(part, i + 1, trainer);
      progress_->Advance();
    }
  }

  DetectorBatch NextBatch(DetectorPart part, int step, const TablePool& pool) const {
    const std::uint64_t stream = part == DetectorPart::kCamera ? 0xca3e7aull : 0x7ab1eull;
    core::Rng rng = core::StreamRng(options_.seed ^ stream, static_cast<std::uint64_t>(step));
    std::vector<const DetectorExample*> picked;
    for (int i = 0; i < options_.batch; ++i) picked.push_back(&pool.Pick(&rng));
    DetectorBatch batch = BatchOf(picked, options_.scenes.width, options_.scenes.height,
                                  part == DetectorPart::kCamera ? 0.0 : options_.part_share, &rng);
    MoveBatch(device_, &batch);
    AugmentBatch(&batch);
    return batch;
  }

  // Reports the figures since the last report.
  void Report(DetectorPart part, int step) {
    last_ = {step,
             loss_ / counted_,
             {},
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()};
    if (part == DetectorPart::kPixels) {
      last_.metrics = {{"object IoU", sums_.shared / std::max(1.0, sums_.joint)},
                       {"offset error, px", sums_.offset / std::max(1.0, sums_.pixels)}};
    } else {
      const double pictures = std::max(1.0, sums_.pictures);
      last_.metrics = {{"elevation error, deg", sums_.camera[0] / pictures * kDegreesInRadian},
                       {"roll error, deg", sums_.camera[1] / pictures * kDegreesInRadian},
                       {"log focal error", sums_.camera[2] / pictures},
                       {"log height error", sums_.camera[3] / pictures}};
    }
    if (listener_) listener_(last_);
    sums_ = {};
    loss_ = 0.0;
    counted_ = 0;
  }

  void Save(DetectorPart part, int step, nn::Trainer* trainer) {
    const bool is_camera = part == DetectorPart::kCamera;
    trainer->SaveState(step);
    trainer->CopyAverageTo(is_camera ? kept_->camera_part() : kept_->pixel_part());
    nn::CheckpointMetadata card{{"kind", "table detector"},
                                {"step", std::to_string(is_camera ? options_.trainer.steps : step)},
                                {"camera_step", std::to_string(is_camera ? step : 0)},
                                {"batch", std::to_string(options_.batch)},
                                {"width", std::to_string(options_.scenes.width)},
                                {"height", std::to_string(options_.scenes.height)},
                                {"seed", std::to_string(options_.seed)}};
    card.merge(MetadataOf(options_.network));
    nn::SaveCheckpoint(*kept_, card, weights_);
  }

  const TableSceneSources& sources_;
  const DetectorTrainingOptions& options_;
  const std::filesystem::path& weights_;
  core::Progress* progress_;
  const asset_lift::PriorTrainingListener& listener_;
  torch::Device device_;
  DetectorNetwork network_, kept_;
  DetectorSums sums_;
  double loss_ = 0.0;
  int counted_ = 0;
  asset_lift::PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

DetectorTrainingOptions::DetectorTrainingOptions() {
  trainer.steps = 10000;
  trainer.learning_rate = 2e-3;
  trainer.save_every = 200;
  camera_trainer.steps = 4000;
  camera_trainer.learning_rate = 1e-3;
  camera_trainer.save_every = 200;
}

bool DetectorTrainingOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (!trainer.IsValid(error) || !camera_trainer.IsValid(error) || !scenes.IsValid(error))
    return false;
  if (batch < 1) return fail("training needs at least one picture per step");
  if (!(part_share >= 0.0 && part_share <= 1.0)) return fail("part_share must lie in [0, 1]");
  if (pool < 1 || exchange < 0 || exchange > pool) return fail("the pool is too small");
  if (!network.IsValid(error)) return false;
  if (scenes.width % network.side_step() != 0 || scenes.height % network.side_step() != 0) {
    return fail("the sides of the pictures must be multiples of 8 patches of the network");
  }
  return true;
}

asset_lift::PriorTrainingReport TrainDetector(const TableSceneSources& sources,
                                              const DetectorTrainingOptions& options,
                                              const std::filesystem::path& weights,
                                              core::Progress* progress,
                                              const asset_lift::PriorTrainingListener& report) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "detector training");
  nn::PrepareForWork();
  torch::manual_seed(static_cast<std::int64_t>(options.seed));
  return DetectorTraining(sources, options, weights, progress, report).Run();
}

}  // namespace simwright::twin
