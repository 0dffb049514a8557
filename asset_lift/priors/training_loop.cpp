#include "asset_lift/priors/training_loop.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "core/error.h"
#include "nn/checkpoint.h"
#include "nn/trainer.h"

namespace simwright::asset_lift {
namespace {

constexpr int kStepsPerReport = 50;

// Accumulates the metrics of the steps and reports their means at intervals and at the end.
class TrainingMeans {
 public:
  TrainingMeans(std::vector<std::string> names, int steps, const PriorTrainingListener& listener)
      : names_(std::move(names)), sums_(names_.size(), 0.0), steps_(steps), listener_(listener) {}

  void Add(int step, const PriorLoss& loss) {
    loss_ += loss.total.item<double>();
    for (size_t i = 0; i < sums_.size(); ++i) sums_[i] += loss.metrics[i];
    ++count_;
    if ((step + 1) % kStepsPerReport != 0 && step + 1 != steps_) return;
    last_ = {step + 1, loss_ / count_, {}, 0.0};
    last_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    for (size_t i = 0; i < sums_.size(); ++i) {
      last_.metrics.emplace_back(names_[i], sums_[i] / count_);
    }
    if (listener_) listener_(last_);
    sums_.assign(names_.size(), 0.0);
    loss_ = 0.0;
    count_ = 0;
  }

  const PriorTrainingReport& last() const { return last_; }

 private:
  std::vector<std::string> names_;
  std::vector<double> sums_;
  int steps_;
  const PriorTrainingListener& listener_;
  double loss_ = 0.0;
  int count_ = 0;
  PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

bool PriorTrainingOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (!trainer.IsValid(error)) return false;
  if (batch < 1) return fail("training needs at least one photo per step");
  if (fresh < 0 || fresh > batch)
    return fail("a step cannot render more new photos than its batch");
  if (fresh > 0 && fresh < batch && memory < batch) {
    return fail("training on photos of earlier steps needs a memory of at least one batch");
  }
  if (memory < 0 || (memory > 0 && (fresh == 0 || fresh == batch))) {
    return fail("a memory of photos serves only steps with fewer new photos than their batch");
  }
  if (pool < 1 || exchange < 0 || exchange > pool) return fail("the pool is too small");
  if (!(parametric_share >= 0.0 && parametric_share <= 1.0)) {
    return fail("parametric_share must be in [0, 1]");
  }
  if (sampler && !(sampler_share >= 0.0 && parametric_share + sampler_share <= 1.0)) {
    return fail("sampler_share and parametric_share must be at least 0 and sum to at most 1");
  }
  if (shape_channels.empty() || shape_channels.size() > 6 ||
      std::any_of(shape_channels.begin(), shape_channels.end(), [](int channels) {
        return channels < 8 || channels > 4096 || channels % 8 != 0;
      })) {
    return fail("shape_channels must be one to six multiples of 8, at most 4096");
  }
  return true;
}

PriorTrainingReport TrainPrior(const PriorTraining& training,
                               const std::vector<core::TexturedMesh>& meshes,
                               const PriorTrainingOptions& options,
                               const std::filesystem::path& weights, core::Progress* progress,
                               const PriorTrainingListener& listener,
                               const PriorBatchSource& source) {
  if (!options.start.empty()) {
    nn::LoadCheckpoint(options.start, training.kind, training.network);
  }
  nn::Trainer trainer(training.network, options.trainer, weights.string() + ".state");
  const int first = trainer.first_step(), steps = options.trainer.steps;
  progress->Stage("preparing shapes");
  // A resumed training uses new objects.
  TrainingPool pool(
      {&meshes, options.parametric_share, options.sampler, options.sampler_share}, options.pool,
      options.seed + training.seed_offset + 1000003ull * static_cast<std::uint64_t>(first));
  progress->Stage(training.kind + " prior", steps - first);
  TrainingMeans means(training.metrics, steps, listener);
  // Preparing few objects does not keep all cores busy: it runs beside the rendering of the others.
  const auto draw = [&](int step) {
    auto prepared = std::async(std::launch::async, [&] { return pool.Prepare(options.exchange); });
    PriorBatch batch = source(pool, step);
    pool.Exchange(prepared.get());
    return batch;
  };
  // One batch is prepared ahead: neither rendering nor the network alone keeps all cores busy.
  std::future<PriorBatch> next = std::async(std::launch::async, draw, first);
  for (int i = first; i < steps; ++i) {
    const PriorBatch batch = next.get();
    if (i + 1 < steps) next = std::async(std::launch::async, draw, i + 1);
    const PriorLoss loss = batch();
    trainer.Step(i, loss.total);
    means.Add(i, loss);
    if (trainer.SaveDue(i)) {
      trainer.SaveState(i + 1);
      trainer.CopyAverageTo(training.kept);
      nn::CheckpointMetadata metadata{{"kind", training.kind},
                                      {"step", std::to_string(i + 1)},
                                      {"batch", std::to_string(options.batch)},
                                      {"seed", std::to_string(options.seed)},
                                      {"meshes", std::to_string(meshes.size())}};
      metadata.insert(training.sizes.begin(), training.sizes.end());
      nn::SaveCheckpoint(*training.kept, metadata, weights, training.precision);
    }
    progress->Advance();
  }
  progress->Finish();
  trainer.Finish();
  return means.last();
}

}  // namespace simwright::asset_lift
