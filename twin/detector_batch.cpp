#include "twin/detector_batch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel.h"
#include "twin/detector_network.h"

namespace simwright::twin {
namespace {

constexpr int kLeastPixels = 10;  // an object with fewer in the picture is left out

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

}  // namespace

DetectorBatch BatchOf(const std::vector<const DetectorExample*>& examples, int width, int height,
                      double part_share, core::Rng* rng) {
  const auto size = static_cast<std::int64_t>(examples.size());
  const size_t bytes = static_cast<size_t>(width) * height * 3;
  std::vector<std::uint8_t> pixels(bytes * examples.size());
  DetectorBatch batch;
  batch.object = torch::zeros({size, 1, height, width});
  batch.known = torch::ones({size, 1, height, width});
  batch.centre = torch::zeros({size, 1, height, width});
  batch.offset = torch::zeros({size, 2, height, width});
  std::vector<std::uint64_t> seeds;
  for (size_t i = 0; i < examples.size(); ++i) seeds.push_back((*rng)());
  core::ParallelFor(static_cast<int>(size), [&](int i) {
    const auto at = static_cast<size_t>(i);
    core::Rng own(seeds[at]);
    DetectorExample part;
    const bool is_part = core::Uniform(own) < part_share;
    if (is_part) part = PartOfExample(*examples[at], width, height, &own);
    const DetectorExample& example = is_part ? part : *examples[at];
    std::copy(example.picture.begin(), example.picture.end(),
              pixels.begin() + static_cast<std::ptrdiff_t>(bytes * at));
    WriteTruth(example, i, width, height, &batch);
  });
  batch.pictures = DetectorPictures(pixels.data(), static_cast<int>(size), height, width).clone();
  return batch;
}

void MoveBatch(const torch::Device& device, DetectorBatch* batch) {
  for (torch::Tensor* t :
       {&batch->pictures, &batch->object, &batch->known, &batch->centre, &batch->offset}) {
    *t = t->to(device);
  }
}

DetectorBatch PartOfBatch(const DetectorBatch& batch, std::int64_t first, std::int64_t count) {
  const auto cut = [&](const torch::Tensor& t) { return t.slice(0, first, first + count); };
  return {cut(batch.pictures), cut(batch.object), cut(batch.known), cut(batch.centre),
          cut(batch.offset)};
}

void AugmentBatch(DetectorBatch* batch) {
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

}  // namespace simwright::twin
