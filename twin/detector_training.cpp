#include "twin/detector_training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "nn/checkpoint.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "twin/detector_example.h"
#include "twin/detector_network.h"

namespace simwright::twin {
namespace {

constexpr int kReportSteps = 50;
constexpr int kLeastPixels = 10;  // an object with fewer in the picture is left out

struct DetectorBatch {
  torch::Tensor pictures;  // (B x 3 x H x W)
  torch::Tensor object;    // (B x 1 x H x W) 1: an object
  torch::Tensor known;     // (B x 1 x H x W) 0: left out
  torch::Tensor centre;    // (B x 1 x H x W) heat in [0, 1]
  torch::Tensor offset;    // (B x 2 x H x W)
  torch::Tensor camera;    // (B x 4)
  torch::Tensor whole;     // (B) 0: a part of a picture, which does not tell the camera
};

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

struct ObjectPixels {
  double x = 0.0, y = 0.0;  // sums, then the centre
  int count = 0;
};

// Writes the truth of picture `b`.
void WriteTruth(const DetectorExample& example, std::int64_t b, int width, int height,
                DetectorBatch* batch) {
  std::map<int, ObjectPixels> objects;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int label = example.object[static_cast<size_t>(y) * width + x];
      if (label == 0) continue;
      ObjectPixels& object = objects[label];
      object.x += x;
      object.y += y;
      ++object.count;
    }
  }
  for (auto& [label, object] : objects) {
    object.x /= object.count;
    object.y /= object.count;
  }
  auto inside = batch->object.accessor<float, 4>();
  auto known = batch->known.accessor<float, 4>();
  auto centre = batch->centre.accessor<float, 4>();
  auto offset = batch->offset.accessor<float, 4>();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int label = example.object[static_cast<size_t>(y) * width + x];
      for (const auto& [other, object] : objects) {
        if (object.count < kLeastPixels) continue;
        const double sigma = 1.5 + 0.06 * std::sqrt(object.count);
        const double squares = (object.x - x) * (object.x - x) + (object.y - y) * (object.y - y);
        if (squares > 16.0 * sigma * sigma) continue;
        const auto heat = static_cast<float>(std::exp(-0.5 * squares / (sigma * sigma)));
        centre[b][0][y][x] = std::max(centre[b][0][y][x], heat);
      }
      if (label == 0) continue;
      const ObjectPixels& object = objects.at(label);
      if (object.count < kLeastPixels) {
        known[b][0][y][x] = 0.0f;
        continue;
      }
      inside[b][0][y][x] = 1.0f;
      offset[b][0][y][x] = static_cast<float>((object.x - x) / kOffsetUnit);
      offset[b][1][y][x] = static_cast<float>((object.y - y) / kOffsetUnit);
    }
  }
}

// Returns a part of a picture, 0.6 to 1 of its sides, enlarged to its size: objects of other sizes.
DetectorExample PartOfExample(const DetectorExample& example, int width, int height,
                              core::Rng* rng) {
  const double side = core::Uniform(*rng, 0.6, 1.0);
  const double left = core::Uniform(*rng, 0.0, (1.0 - side) * width);
  const double top = core::Uniform(*rng, 0.0, (1.0 - side) * height);
  DetectorExample part;
  part.picture.resize(example.picture.size());
  part.object.resize(example.object.size());
  part.camera = example.camera;
  const auto clamped = [](double at, int size) { return std::clamp(at, 0.0, size - 1.001); };
  for (int y = 0; y < height; ++y) {
    const double sy = clamped(top + side * (y + 0.5) - 0.5, height);
    const auto y0 = static_cast<size_t>(sy);
    const double ty = sy - static_cast<double>(y0);
    for (int x = 0; x < width; ++x) {
      const double sx = clamped(left + side * (x + 0.5) - 0.5, width);
      const auto x0 = static_cast<size_t>(sx);
      const double tx = sx - static_cast<double>(x0);
      const size_t row = static_cast<size_t>(width), from = y0 * row + x0;
      const size_t to = static_cast<size_t>(y) * row + static_cast<size_t>(x);
      for (size_t c = 0; c < 3; ++c) {
        const auto at = [&](size_t pixel) {
          return static_cast<double>(example.picture[3 * pixel + c]);
        };
        const double value = (1.0 - ty) * ((1.0 - tx) * at(from) + tx * at(from + 1)) +
                             ty * ((1.0 - tx) * at(from + row) + tx * at(from + row + 1));
        part.picture[3 * to + c] = static_cast<std::uint8_t>(value + 0.5);
      }
      part.object[to] = example.object[from + (tx > 0.5 ? 1 : 0) + (ty > 0.5 ? row : 0)];
    }
  }
  return part;
}

DetectorBatch BatchOf(const TablePool& pool, const DetectorTrainingOptions& options,
                      core::Rng rng) {
  const int width = options.scenes.width, height = options.scenes.height, size = options.batch;
  const size_t bytes = static_cast<size_t>(width) * height * 3;
  std::vector<std::uint8_t> pixels(bytes * static_cast<size_t>(size));
  DetectorBatch batch;
  batch.object = torch::zeros({size, 1, height, width});
  batch.known = torch::ones({size, 1, height, width});
  batch.centre = torch::zeros({size, 1, height, width});
  batch.offset = torch::zeros({size, 2, height, width});
  batch.camera = torch::empty({size, kCameraNumbers});
  batch.whole = torch::ones({size});
  std::vector<const DetectorExample*> picked;
  std::vector<std::uint64_t> seeds;
  for (int i = 0; i < size; ++i) {
    picked.push_back(&pool.Pick(&rng));
    seeds.push_back(rng());
  }
  core::ParallelFor(size, [&](int i) {
    core::Rng own(seeds[static_cast<size_t>(i)]);
    DetectorExample part;
    const bool is_part = core::Uniform(own) < options.part_share;
    if (is_part) {
      part = PartOfExample(*picked[static_cast<size_t>(i)], width, height, &own);
      batch.whole[i] = 0.0;
    }
    const DetectorExample& example = is_part ? part : *picked[static_cast<size_t>(i)];
    std::copy(example.picture.begin(), example.picture.end(),
              pixels.begin() + static_cast<std::ptrdiff_t>(bytes) * i);
    WriteTruth(example, i, width, height, &batch);
  });
  auto camera = batch.camera.accessor<float, 2>();
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < kCameraNumbers; ++k) {
      camera[i][k] = picked[static_cast<size_t>(i)]->camera[static_cast<size_t>(k)];
    }
  }
  batch.pictures = DetectorPictures(pixels.data(), size, height, width).clone();
  return batch;
}

// Mirrors a part of the pictures, and changes colours as cameras do: exposure, white balance,
// contrast, blur and noise.
void Augment(DetectorBatch* batch) {
  const auto count = batch->pictures.size(0);
  const torch::TensorOptions like = batch->pictures.options();
  const torch::Tensor mirrored = torch::rand({count, 1, 1, 1}, like) < 0.5;
  const auto flip = [&](torch::Tensor* t) {
    *t = torch::where(mirrored, torch::flip(*t, {3}), *t);
  };
  for (torch::Tensor* t :
       {&batch->pictures, &batch->object, &batch->known, &batch->centre, &batch->offset}) {
    flip(t);
  }
  const torch::Tensor sign = 1.0 - 2.0 * mirrored.to(torch::kFloat).reshape({count});
  batch->offset.select(1, 0).mul_(sign.reshape({count, 1, 1}));
  batch->camera.select(1, 1).mul_(sign);
  torch::Tensor color = 0.5 * (batch->pictures + 1.0);
  color = color * torch::exp(0.25 * torch::randn({count, 1, 1, 1}, like) +
                             0.08 * torch::randn({count, 3, 1, 1}, like));
  const torch::Tensor gamma = torch::exp(0.2 * torch::randn({count, 1, 1, 1}, like));
  color = torch::pow(torch::clamp(color, 1e-3, 1.0), gamma);
  color = torch::where(torch::rand({count, 1, 1, 1}, like) < 0.35,
                       torch::avg_pool2d(color, 3, 1, 1), color);
  color = color + 0.04 * torch::rand({count, 1, 1, 1}, like) * torch::randn_like(color);
  batch->pictures = 2.0 * torch::clamp(color, 0.0, 1.0) - 1.0;
}

DetectorBatch PartOf(const DetectorBatch& batch, std::int64_t first, std::int64_t count) {
  const auto cut = [&](const torch::Tensor& t) { return t.slice(0, first, first + count); };
  return {cut(batch.pictures), cut(batch.object), cut(batch.known), cut(batch.centre),
          cut(batch.offset),   cut(batch.camera), cut(batch.whole)};
}

struct DetectorSums {
  torch::Tensor loss;  // scalar: the sum over pictures
  double shared = 0.0, joint = 0.0, offset = 0.0, pixels = 0.0, whole = 0.0;
  double camera[kCameraNumbers] = {};
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
  const torch::Tensor camera_off = (out.camera - batch.camera).abs();
  const torch::Tensor camera =
      ((camera_off * torch::exp(-out.log_b) + out.log_b).mean(1) * batch.whole).sum();
  DetectorSums sums;
  sums.loss = 3.0 * per_picture(bce) + dice + 3.0 * per_picture(heat) + 0.5 * offset + 0.1 * camera;
  const torch::NoGradGuard no_grad;
  const torch::Tensor found = (out.object > 0.0).to(torch::kFloat);
  sums.shared = (found * batch.object).sum().item<double>();
  sums.joint = torch::clamp_max(found + batch.object, 1.0).sum().item<double>();
  sums.offset = kOffsetUnit * off.sum().item<double>();
  sums.pixels = batch.object.sum().item<double>();
  sums.whole = batch.whole.sum().item<double>();
  for (int k = 0; k < kCameraNumbers; ++k) {
    sums.camera[k] = (camera_off.select(1, k) * batch.whole).sum().item<double>();
  }
  return sums;
}

// Accumulates the figures of the steps until the next report.
class DetectorMeans {
 public:
  DetectorMeans(const DetectorTrainingOptions& options,
                const asset_lift::PriorTrainingListener& listener)
      : options_(options), listener_(listener) {}

  void Add(int step, const std::vector<DetectorSums>& parts, double loss) {
    loss_ += loss;
    ++count_;
    for (const DetectorSums& part : parts) {
      sums_.shared += part.shared;
      sums_.joint += part.joint;
      sums_.offset += part.offset;
      sums_.pixels += part.pixels;
      sums_.whole += part.whole;
      for (int k = 0; k < kCameraNumbers; ++k) sums_.camera[k] += part.camera[k];
    }
    if ((step + 1) % kReportSteps != 0 && step + 1 != options_.trainer.steps) return;
    const double pictures = std::max(1.0, sums_.whole);
    last_ = {step + 1,
             loss_ / count_,
             {{"object IoU", sums_.shared / std::max(1.0, sums_.joint)},
              {"offset error, px", sums_.offset / std::max(1.0, sums_.pixels)},
              {"elevation error, deg", sums_.camera[0] / pictures * 180.0 / M_PI},
              {"log focal error", sums_.camera[2] / pictures},
              {"log height error", sums_.camera[3] / pictures}},
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()};
    if (listener_) listener_(last_);
    sums_ = {};
    loss_ = 0.0;
    count_ = 0;
  }
  const asset_lift::PriorTrainingReport& last() const { return last_; }

 private:
  const DetectorTrainingOptions& options_;
  const asset_lift::PriorTrainingListener& listener_;
  DetectorSums sums_;
  double loss_ = 0.0;
  int count_ = 0;
  asset_lift::PriorTrainingReport last_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
  network->to(device);
  nn::Trainer trainer(network.get(), options.trainer, weights.string() + ".state");
  const int first = trainer.first_step(), steps = options.trainer.steps;
  progress->Stage("rendering pictures", 100);
  // A resumed training uses new pictures.
  TablePool pool(sources, options, options.seed + 1000003ull * static_cast<std::uint64_t>(first),
                 [&] { progress->Advance(); });
  progress->Stage("table detector", steps - first);
  DetectorMeans means(options, report);
  const int shares = nn::ShareCount(device, options.batch);
  for (int i = first; i < steps; ++i) {
    auto rendered = std::async(std::launch::async, [&] { return pool.Render(options.exchange); });
    DetectorBatch batch = BatchOf(
        pool, options, core::StreamRng(options.seed ^ 0x7ab1eull, static_cast<std::uint64_t>(i)));
    for (torch::Tensor* t : {&batch.pictures, &batch.object, &batch.known, &batch.centre,
                             &batch.offset, &batch.camera, &batch.whole}) {
      *t = t->to(device);
    }
    Augment(&batch);
    std::vector<DetectorSums> parts(static_cast<size_t>(shares));
    const double loss = trainer.Step(i, shares, [&](int share) {
      const nn::Share part = nn::ShareOf(options.batch, shares, share);
      DetectorSums& sums = parts[static_cast<size_t>(share)];
      sums = LossesOn(network.get(), PartOf(batch, part.first, part.count));
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
