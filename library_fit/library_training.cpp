#include "library_fit/library_training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "core/error.h"
#include "library_fit/example_pool.h"
#include "library_fit/library_network.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/trainer.h"

namespace simwright::library_fit {
namespace {

constexpr int kReportSteps = 50;

struct LibraryBatch {
  torch::Tensor pictures;  // (B x 4 x S x S)
  torch::Tensor kinds;     // (B) int64
  torch::Tensor azimuth;   // (B) rad
  torch::Tensor frontal;   // (B) 1 for articulated kinds
  torch::Tensor choices;   // (B x (kPriorDraws + 1)) int64 bins, -1 for none
  torch::Tensor numbers;   // (B x 5)
};

// Changes colours and masks as cameras and segmentation do: exposure, tint, noise, and for some
// pictures an outline that is off by a pixel, with the background's colour where it is too wide.
torch::Tensor Augmented(const torch::Tensor& pictures) {
  const auto count = pictures.size(0);
  const torch::TensorOptions like = pictures.options();
  torch::Tensor alpha = pictures.slice(1, 3, 4);
  torch::Tensor color = (pictures.slice(1, 0, 3) / torch::clamp_min(alpha, 1e-3) + 1.0) * 0.5;
  color = torch::where(alpha > 0.02, color, torch::rand({count, 3, 1, 1}, like));
  color = color * (1.0 + 0.15 * torch::randn({count, 1, 1, 1}, like) +
                   0.05 * torch::randn({count, 3, 1, 1}, like));
  color = torch::where(torch::rand({count, 1, 1, 1}, like) < 0.3, torch::avg_pool2d(color, 3, 1, 1),
                       color);
  color = color + 0.03 * torch::rand({count, 1, 1, 1}, like) * torch::randn_like(color);
  const torch::Tensor rough = torch::nn::functional::interpolate(
      torch::randn({count, 1, 16, 16}, like),
      torch::nn::functional::InterpolateFuncOptions()
          .size(std::vector<std::int64_t>{kPriorSide, kPriorSide})
          .mode(torch::kBilinear)
          .align_corners(false));
  const torch::Tensor strength = 0.3 * torch::rand({count, 1, 1, 1}, like);
  const torch::Tensor moved = torch::clamp(
      (torch::avg_pool2d(alpha, 3, 1, 1) + strength * rough - 0.5) * 4.0 + 0.5, 0.0, 1.0);
  alpha = torch::where(torch::rand({count, 1, 1, 1}, like) < 0.4, moved, alpha);
  return torch::cat({(2.0 * torch::clamp(color, 0.0, 1.0) - 1.0) * alpha, alpha}, 1);
}

LibraryBatch BatchOf(const ExamplePool& pool, int size, core::Rng rng) {
  const size_t bytes = static_cast<size_t>(kPriorSide) * kPriorSide * 4;
  std::vector<std::uint8_t> pixels(bytes * static_cast<size_t>(size));
  LibraryBatch batch;
  batch.kinds = torch::empty({size}, torch::kLong);
  batch.azimuth = torch::empty({size});
  batch.frontal = torch::empty({size});
  batch.choices = torch::full({size, kPriorDraws + 1}, -1, torch::kLong);
  batch.numbers = torch::empty({size, 5});
  auto kinds = batch.kinds.accessor<std::int64_t, 1>();
  auto azimuth = batch.azimuth.accessor<float, 1>();
  auto frontal = batch.frontal.accessor<float, 1>();
  auto choices = batch.choices.accessor<std::int64_t, 2>();
  auto numbers = batch.numbers.accessor<float, 2>();
  for (int i = 0; i < size; ++i) {
    const PriorExample& e = pool.at(static_cast<int>(core::UniformIndex(rng, pool.size())));
    std::copy(e.picture.begin(), e.picture.end(),
              pixels.begin() + static_cast<std::ptrdiff_t>(bytes) * i);
    kinds[i] = e.kind;
    azimuth[i] = static_cast<float>(std::fmod(e.view.azimuth + 4.0 * M_PI, 2.0 * M_PI));
    frontal[i] = FitKinds()[static_cast<size_t>(e.kind)].articulated != nullptr ? 1.0f : 0.0f;
    for (int k = 0; k <= kPriorDraws; ++k) {
      const float choice = e.choices[static_cast<size_t>(k)];
      if (choice >= 0.0f)
        choices[i][k] = std::min(kChoiceBins - 1, static_cast<int>(choice * kChoiceBins));
    }
    for (int k = 0; k < 3; ++k) numbers[i][k] = e.log_size[static_cast<size_t>(k)];
    numbers[i][3] = static_cast<float>(e.view.elevation);
    numbers[i][4] = static_cast<float>(10.0 * e.view.nearness);
  }
  batch.pictures = LibraryPictures(pixels.data(), size).clone();
  return batch;
}

LibraryBatch PartOf(const LibraryBatch& batch, std::int64_t first, std::int64_t count) {
  const auto cut = [&](const torch::Tensor& t) { return t.slice(0, first, first + count); };
  return {cut(batch.pictures), cut(batch.kinds),   cut(batch.azimuth),
          cut(batch.frontal),  cut(batch.choices), cut(batch.numbers)};
}

struct LibrarySums {
  torch::Tensor loss;    // scalar: the sum over pictures
  double right = 0.0;    // pictures whose kind is right
  double azimuth = 0.0;  // rad, sum of errors of articulated kinds, and their number
  double frontal = 0.0;
  double size = 0.0;  // sum of the mean errors of the logarithms
};

// Sums the losses: cross-entropy of the kind, the azimuth's and the choices' bins, and the Laplace
// likelihood of size, elevation and nearness.
LibrarySums LossesOn(LibraryNetworkImpl* network, const LibraryBatch& batch) {
  namespace F = torch::nn::functional;
  const torch::Tensor features = network->Features(batch.pictures);
  const torch::Tensor logits = network->KindLogits(features);
  const LibraryNetworkOutput out = network->Parameters(features, batch.kinds);
  const torch::Tensor kind =
      F::cross_entropy(logits, batch.kinds,
                       F::CrossEntropyFuncOptions().reduction(torch::kSum).label_smoothing(0.03));
  // The azimuth's mass is shared by the two nearest bins.
  const torch::Tensor turn = batch.azimuth * (kAzimuthBins / (2.0 * M_PI)) - 0.5;
  const torch::Tensor low = torch::floor(turn), share = (turn - low).unsqueeze(1);
  const torch::Tensor first = torch::remainder(low, kAzimuthBins).to(torch::kLong).unsqueeze(1);
  const torch::Tensor second = torch::remainder(first + 1, kAzimuthBins);
  const torch::Tensor log_azimuth = torch::log_softmax(out.azimuth, 1);
  const torch::Tensor azimuth =
      -(log_azimuth.gather(1, first) * (1.0 - share) + log_azimuth.gather(1, second) * share).sum();
  const torch::Tensor known = (batch.choices >= 0).to(torch::kFloat);
  const torch::Tensor choices = -(torch::log_softmax(out.choices, 2)
                                      .gather(2, torch::clamp_min(batch.choices, 0).unsqueeze(2))
                                      .squeeze(2) *
                                  known)
                                     .sum();
  const torch::Tensor off = (out.numbers.slice(1, 0, 5) - batch.numbers).abs();
  const torch::Tensor log_b = torch::clamp(out.numbers.slice(1, 5, 10), -4.0, 2.0);
  const torch::Tensor numbers = (off * torch::exp(-log_b) + log_b).sum();
  LibrarySums sums;
  sums.loss = kind + 0.5 * azimuth + 0.3 * choices + 0.2 * numbers;
  const torch::NoGradGuard no_grad;
  sums.right = (logits.argmax(1) == batch.kinds).sum().item<double>();
  const torch::Tensor guess =
      (out.azimuth.argmax(1).to(torch::kFloat) + 0.5) * (2.0 * M_PI / kAzimuthBins);
  const torch::Tensor apart = torch::remainder(guess - batch.azimuth + M_PI, 2.0 * M_PI) - M_PI;
  sums.azimuth = (apart.abs() * batch.frontal).sum().item<double>();
  sums.frontal = batch.frontal.sum().item<double>();
  sums.size = off.slice(1, 0, 3).mean(1).sum().item<double>();
  return sums;
}

// Returns the share of pictures that show an instance among other objects.
double SceneShare(const LibraryTrainingOptions& options) {
  return options.scene_example ? options.scene_share : 0.0;
}

// Accumulates the figures of the steps until the next report.
class LibraryMeans {
 public:
  LibraryMeans(int steps, const asset_lift::PriorTrainingListener& listener)
      : steps_(steps), listener_(listener) {}
  void Add(int step, const std::vector<LibrarySums>& parts, double loss, int batch) {
    loss_ += loss;
    ++count_;
    for (const LibrarySums& part : parts) {
      sums_.right += part.right / batch;
      sums_.azimuth += part.azimuth;
      sums_.frontal += part.frontal;
      sums_.size += part.size / batch;
    }
    if ((step + 1) % kReportSteps != 0 && step + 1 != steps_) return;
    last_ = {step + 1,
             loss_ / count_,
             {{"kind accuracy", sums_.right / count_},
              {"azimuth error, deg", sums_.azimuth / std::max(1.0, sums_.frontal) * 180.0 / M_PI},
              {"log size error", sums_.size / count_}},
             0.0};
    last_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (listener_) listener_(last_);
    sums_ = {};
    loss_ = 0.0;
    count_ = 0;
  }
  const asset_lift::PriorTrainingReport& last() const { return last_; }

 private:
  int steps_;
  const asset_lift::PriorTrainingListener& listener_;
  LibrarySums sums_;
  double loss_ = 0.0;
  int count_ = 0;
  asset_lift::PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

LibraryTrainingOptions::LibraryTrainingOptions() {
  trainer.steps = 2400;
  trainer.learning_rate = 1.5e-3;
}

bool LibraryTrainingOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (!trainer.IsValid(error)) return false;
  if (batch < 1) return fail("training needs at least one picture per step");
  if (channels.size() != 4 || features < 8 || features % 8 != 0 ||
      std::any_of(channels.begin(), channels.end(),
                  [](int count) { return count < 8 || count > 4096 || count % 8 != 0; })) {
    return fail("the network needs four channel counts and a feature count, multiples of 8");
  }
  if (pool < 1 || exchange < 0 || exchange > pool) return fail("the pool is too small");
  if (!(scene_share >= 0.0 && scene_share <= 1.0)) return fail("a share must be within 0 and 1");
  return true;
}

asset_lift::PriorTrainingReport TrainLibraryNetwork(
    const LibraryTrainingOptions& options, const std::filesystem::path& weights,
    core::Progress* progress, const asset_lift::PriorTrainingListener& report) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "prior training");
  nn::PrepareForWork();
  torch::manual_seed(static_cast<std::int64_t>(options.seed));
  const torch::Device device = nn::BestDevice();
  const int kinds = static_cast<int>(FitKinds().size());
  LibraryNetworkOptions sizes;
  sizes.channels = options.channels;
  sizes.features = options.features;
  LibraryNetwork network(kinds, sizes), kept(kinds, sizes);
  if (!options.start.empty()) nn::LoadCheckpoint(options.start, "library", network.get());
  network->to(device);
  nn::Trainer trainer(network.get(), options.trainer, weights.string() + ".state");
  const int first = trainer.first_step(), steps = options.trainer.steps;
  progress->Stage("rendering pictures", 100);
  // A resumed training uses new pictures.
  ExamplePool pool(options, options.seed + 1000003ull * static_cast<std::uint64_t>(first),
                   [&] { progress->Advance(); });
  progress->Stage("library prior", steps - first);
  LibraryMeans means(steps, report);
  const int shares = nn::ShareCount(device, options.batch);
  for (int i = first; i < steps; ++i) {
    auto rendered = std::async(std::launch::async, [&] { return pool.Render(options.exchange); });
    LibraryBatch batch =
        BatchOf(pool, options.batch,
                core::StreamRng(options.seed ^ 0x11bull, static_cast<std::uint64_t>(i)));
    for (torch::Tensor* t : {&batch.pictures, &batch.kinds, &batch.azimuth, &batch.frontal,
                             &batch.choices, &batch.numbers}) {
      *t = t->to(device);
    }
    batch.pictures = Augmented(batch.pictures);
    std::vector<LibrarySums> parts(static_cast<size_t>(shares));
    const double loss = trainer.Step(i, shares, [&](int share) {
      const nn::Share part = nn::ShareOf(options.batch, shares, share);
      LibrarySums& sums = parts[static_cast<size_t>(share)];
      sums = LossesOn(network.get(), PartOf(batch, part.first, part.count));
      return sums.loss / options.batch;
    });
    means.Add(i, parts, loss, options.batch);
    pool.Exchange(rendered.get());
    if (trainer.SaveDue(i)) {
      trainer.SaveState(i + 1);
      trainer.CopyAverageTo(kept.get());
      nn::CheckpointMetadata card{{"kind", "library"},
                                  {"kinds", std::to_string(kinds)},
                                  {"step", std::to_string(i + 1)},
                                  {"batch", std::to_string(options.batch)},
                                  {"seed", std::to_string(options.seed)},
                                  {"start", options.start.filename().string()},
                                  {"scene_share", std::to_string(SceneShare(options))}};
      card.merge(sizes.Metadata());
      nn::SaveCheckpoint(*kept, card, weights);
    }
    progress->Advance();
  }
  progress->Finish();
  trainer.Finish();
  return means.last();
}

}  // namespace simwright::library_fit
