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

// The sums of a batch's figures over its pixels or objects.
struct DetectorSums {
  torch::Tensor loss;  // scalar: the sum over pictures
  double shared = 0.0, joint = 0.0, offset = 0.0, pixels = 0.0;
};

DetectorSums LossesOn(DetectorNetworkImpl* network, const DetectorBatch& batch) {
  const DetectorOutput out = network->Detect(batch.pictures);
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

// Accumulates the figures of the steps until the next report.
class DetectorMeans {
 public:
  DetectorMeans(int steps, const asset_lift::PriorTrainingListener& listener)
      : steps_(steps), listener_(listener) {}

  void Add(int step, const std::vector<DetectorSums>& parts, double loss) {
    loss_ += loss;
    ++count_;
    for (const DetectorSums& part : parts) {
      sums_.shared += part.shared;
      sums_.joint += part.joint;
      sums_.offset += part.offset;
      sums_.pixels += part.pixels;
    }
    if ((step + 1) % kReportSteps != 0 && step + 1 != steps_) return;
    last_ = {step + 1,
             loss_ / count_,
             {{"object IoU", sums_.shared / std::max(1.0, sums_.joint)},
              {"offset error, px", sums_.offset / std::max(1.0, sums_.pixels)}},
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()};
    if (listener_) listener_(last_);
    sums_ = {};
    loss_ = 0.0;
    count_ = 0;
  }
  const asset_lift::PriorTrainingReport& last() const { return last_; }

 private:
  int steps_;
  const asset_lift::PriorTrainingListener& listener_;
  DetectorSums sums_;
  double loss_ = 0.0;
  int count_ = 0;
  asset_lift::PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

DetectorBatch BatchFrom(const TablePool& pool, const DetectorTrainingOptions& options, int step) {
  core::Rng rng = core::StreamRng(options.seed ^ 0x7ab1eull, static_cast<std::uint64_t>(step));
  std::vector<const DetectorExample*> picked;
  for (int i = 0; i < options.batch; ++i) picked.push_back(&pool.Pick(&rng));
  return BatchOf(picked, options.scenes.width, options.scenes.height, options.part_share, &rng);
}

void SaveWeights(const DetectorNetwork& network, const DetectorTrainingOptions& options, int step,
                 const std::filesystem::path& weights) {
  nn::CheckpointMetadata card{{"kind", "table detector"},
                              {"step", std::to_string(step)},
                              {"batch", std::to_string(options.batch)},
                              {"width", std::to_string(options.scenes.width)},
                              {"height", std::to_string(options.scenes.height)},
                              {"seed", std::to_string(options.seed)}};
  card.merge(MetadataOf(options.network));
  nn::SaveCheckpoint(*network, card, weights);
}

}  // namespace

DetectorTrainingOptions::DetectorTrainingOptions() {
  trainer.steps = 10000;
  trainer.learning_rate = 2e-3;
  trainer.save_every = 200;
}

bool DetectorTrainingOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (!trainer.IsValid(error) || !scenes.IsValid(error)) return false;
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
  const torch::Device device = nn::BestDevice();
  DetectorNetwork network(options.network), kept(options.network);
  if (!options.start.empty()) nn::LoadCheckpoint(options.start, "table detector", network.get());
  network->to(device);
  nn::Trainer trainer(network.get(), options.trainer, weights.string() + ".state");
  const int first = trainer.first_step(), steps = options.trainer.steps;
  progress->Stage("rendering pictures", 100);
  // A resumed training uses new pictures.
  TablePool pool(sources, options, options.seed + 1000003ull * static_cast<std::uint64_t>(first),
                 [&] { progress->Advance(); });
  progress->Stage("table detector", steps - first);
  DetectorMeans means(steps, report);
  const int shares = nn::ShareCount(device, options.batch);
  for (int i = first; i < steps; ++i) {
    auto rendered = std::async(std::launch::async, [&] { return pool.Render(options.exchange); });
    DetectorBatch batch = BatchFrom(pool, options, i);
    MoveBatch(device, &batch);
    AugmentBatch(&batch);
    std::vector<DetectorSums> parts(static_cast<size_t>(shares));
    const double loss = trainer.Step(i, shares, [&](int share) {
      const nn::Share part = nn::ShareOf(options.batch, shares, share);
      DetectorSums& sums = parts[static_cast<size_t>(share)];
      sums = LossesOn(network.get(), PartOfBatch(batch, part.first, part.count));
      return sums.loss / options.batch;
    });
    means.Add(i, parts, loss);
    pool.Exchange(rendered.get());
    if (trainer.SaveDue(i)) {
      trainer.SaveState(i + 1);
      trainer.CopyAverageTo(kept.get());
      SaveWeights(kept, options, i + 1, weights);
    }
    progress->Advance();
  }
  progress->Finish();
  trainer.Finish();
  return means.last();
}

}  // namespace simwright::twin
