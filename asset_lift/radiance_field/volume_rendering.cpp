#include "asset_lift/radiance_field/volume_rendering.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::asset_lift {
namespace {

constexpr int kTileRays = 64;
constexpr int kMaxSamples = 64;  // maximum samples kept per ray
// The number of samples per ray that are evaluated together: a ray that ends at a surface wastes
// few.
constexpr int kRound = 8;
constexpr double kLeastOpacityOfNormal = 0.1;
// The corners of a tetrahedron about the origin; the differences between them give a gradient: sum
// of e_k f(x + h e_k) = 4 h grad f + O(h^2).
constexpr int kTaps = 4;
constexpr std::array<std::array<int, 3>, kTaps> kTap = {
    {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};

// Computes a well-mixed hash (Wellons, "lowbias32").
std::uint32_t Mixed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

template <typename Real>
struct Sample {
  Real position[3];  // half sides
  Real t;
  Real density;  // per half side
  Real color[3];
};

template <typename Real>
struct Ray {
  Eigen::Vector3d origin, direction;  // half sides
  double near, step;                  // of t
  Real delta;                         // a stratum's length, half sides
  Real transmittance;
  std::uint32_t seed;
  int strata, next;  // the number of strata, and the first unevaluated one
  int count;         // samples kept
};

// The density's raw values around a ray's median point, and the resulting normal.
template <typename Real>
struct Taps {
  Real position[kTaps][3];
  Real normal[3];
  Real slope;  // length of the sum over the taps; 0: no normal
};

template <typename Real>
struct Tile {
  int first = 0, rays = 0;
  std::array<Ray<Real>, kTileRays> ray;
  int stride = 0;                     // numbers in a row of features
  std::vector<Sample<Real>> samples;  // (kTileRays x kMaxSamples)
  std::vector<Real> features;         // (kTileRays x kMaxSamples x stride)
  std::vector<Taps<Real>> taps;       // (kTileRays), empty if normals are off
  std::vector<Real> tap_features;     // (kTileRays x kTaps x stride)
  std::int64_t evaluated = 0;
};

// Collects points with gradients into batches and flushes them as they fill up.
template <typename Real>
class GradientBatches {
 public:
  GradientBatches(const BasicRadianceField<Real>& field, Real* sum)
      : field_(field), sum_(sum), batch_{}, gradient_{} {}

  // Returns the index of the next point, whose features are `features`.
  int Next(const Real* features) {
    if (count_ == kFieldBatch) Flush();
    std::copy_n(features, field_.feature_stride(),
                batch_.features + count_ * field_.feature_stride());
    return count_++;
  }
  void Flush() {
    if (count_ == 0) return;
    field_.AddGradient(batch_, gradient_, sum_);
    gradient_ = {};
    count_ = 0;
  }
  FieldBatch<Real>& batch() { return batch_; }
  FieldBatchGradient<Real>& gradient() { return gradient_; }

 private:
  const BasicRadianceField<Real>& field_;
  Real* sum_;
  FieldBatch<Real> batch_;
  FieldBatchGradient<Real> gradient_;
  int count_ = 0;
};

template <typename Real>
class TileRenderer {
 public:
  TileRenderer(const BasicRadianceField<Real>& field, const OccupancyGrid& occupancy,
               const VolumeRenderOptions& options, Tile<Real>* tile)
      : field_(field), occupancy_(occupancy), options_(options), tile_(*tile) {}

  void Render(const std::vector<FieldRay>& rays, std::uint32_t seed,
              RayRenderings<Real>* pictures) {
    tile_.stride = field_.feature_stride();
    tile_.samples.resize(kTileRays * kMaxSamples);
    tile_.features.resize(static_cast<std::size_t>(kTileRays * kMaxSamples) * tile_.stride);
    tile_.evaluated = 0;
    for (int r = 0; r < tile_.rays; ++r) Start(rays[tile_.first + r], seed, r);
    while (EvaluateNextSamples()) {
    }
    for (int r = 0; r < tile_.rays; ++r) Composite(r, pictures);
    tile_.taps.clear();
    if (options_.normals) TakeNormals(pictures);
  }

 private:
  void Start(const FieldRay& world, std::uint32_t seed, int r) {
    Ray<Real>& ray = tile_.ray[r];
    const RadianceFieldOptions& cube = field_.options();
    ray.origin = (world.origin - cube.center) / cube.half_side;
    ray.direction = world.direction / cube.half_side;
    ray.transmittance = 1;
    ray.seed = Mixed(seed + static_cast<std::uint32_t>(tile_.first + r));
    ray.strata = ray.next = ray.count = 0;
    double far = 1e30;
    ray.near = 0.0;
    if (!occupancy_.Clip(ray.origin, ray.direction, &ray.near, &far)) return;
    const double length = (far - ray.near) * ray.direction.norm();
    const double wanted = std::ceil(length / options_.finest_step);
    ray.strata = std::clamp(static_cast<int>(std::min(wanted, 1e6)), 1, options_.max_samples);
    ray.step = (far - ray.near) / ray.strata;
    ray.delta = static_cast<Real>(length / ray.strata);
  }

  // Evaluates the next few samples of each unfinished ray. Returns false if there is none.
  bool EvaluateNextSamples() {
    pending_.clear();
    for (int r = 0; r < tile_.rays; ++r) {
      Ray<Real>& ray = tile_.ray[r];
      int slot = r * kMaxSamples + ray.count;
      for (int taken = 0; taken < kRound && ray.next < ray.strata;) {
        const std::uint32_t jitter = Mixed(ray.seed ^ (static_cast<std::uint32_t>(ray.next) << 20));
        const double t = ray.near + (ray.next++ + jitter * 0x1p-32) * ray.step;
        const Eigen::Vector3d at = ray.origin + t * ray.direction;
        if (!occupancy_.Occupied(at.x(), at.y(), at.z())) continue;
        Sample<Real>& sample = tile_.samples[slot];
        for (int a = 0; a < 3; ++a) sample.position[a] = static_cast<Real>(at[a]);
        sample.t = static_cast<Real>(t);
        pending_.push_back({slot++, r});
        ++taken;
      }
    }
    if (pending_.empty()) return false;
    tile_.evaluated += static_cast<std::int64_t>(pending_.size());
    for (std::size_t i = 0; i < pending_.size(); i += kFieldBatch) EvaluatePending(i);
    for (const auto& [slot, r] : pending_) {
      Ray<Real>& ray = tile_.ray[r];
      if (ray.transmittance < options_.min_transmittance) continue;
      ++ray.count;
      ray.transmittance *= std::exp(-tile_.samples[slot].density * ray.delta);
      if (ray.transmittance < options_.min_transmittance) ray.next = ray.strata;
    }
    return true;
  }

  void EvaluatePending(std::size_t first) {
    const int count = static_cast<int>(std::min<std::size_t>(kFieldBatch, pending_.size() - first));
    for (int a = 0; a < 3; ++a) {
      for (int s = 0; s < kFieldBatch; ++s) {
        const int slot = pending_[first + std::min(s, count - 1)].slot;
        batch_.position[a][s] = tile_.samples[slot].position[a];
      }
    }
    field_.Evaluate(&batch_);
    for (int s = 0; s < count; ++s) {
      const int slot = pending_[first + s].slot;
      tile_.samples[slot].density = batch_.density[s];
      for (int c = 0; c < 3; ++c) tile_.samples[slot].color[c] = batch_.color[c][s];
      std::copy_n(batch_.features + s * tile_.stride, tile_.stride,
                  &tile_.features[static_cast<std::size_t>(slot) * tile_.stride]);
    }
  }

  void Composite(int r, RayRenderings<Real>* pictures) const {
    const Ray<Real>& ray = tile_.ray[r];
    Real transmittance = 1, color[3] = {0, 0, 0}, depth = 0;
    for (int k = 0; k < ray.count; ++k) {
      const Sample<Real>& sample = tile_.samples[r * kMaxSamples + k];
      const Real through = std::exp(-sample.density * ray.delta);
      const Real weight = transmittance * (1 - through);
      for (int c = 0; c < 3; ++c) color[c] += weight * sample.color[c];
      depth += weight * sample.t;
      transmittance *= through;
    }
    const std::size_t at = static_cast<std::size_t>(tile_.first + r);
    for (int c = 0; c < 3; ++c) pictures->color[3 * at + c] = color[c];
    pictures->opacity[at] = 1 - transmittance;
    pictures->depth[at] = depth;
  }

  // Returns the sample at which half of the ray's opacity is reached.
  const Sample<Real>& Median(int r) const {
    const Ray<Real>& ray = tile_.ray[r];
    const Real half = (1 + ray.transmittance) / 2;
    Real transmittance = 1;
    int k = 0;
    while (true) {
      const Sample<Real>& sample = tile_.samples[r * kMaxSamples + k];
      transmittance *= std::exp(-sample.density * ray.delta);
      if (transmittance <= half || k + 1 == ray.count) return sample;
      ++k;
    }
  }

  void TakeNormals(RayRenderings<Real>* pictures) {
    tile_.taps.resize(kTileRays);
    tile_.tap_features.resize(static_cast<std::size_t>(kTileRays * kTaps) * tile_.stride);
    constexpr int kPerBatch = kFieldBatch / kTaps;
    std::array<int, kPerBatch> rays;
    int count = 0;
    for (int r = 0; r < tile_.rays; ++r) {
      tile_.taps[r].slope = 0;
      const Ray<Real>& ray = tile_.ray[r];
      if (ray.count == 0 || 1 - ray.transmittance < kLeastOpacityOfNormal) continue;
      const Sample<Real>& median = Median(r);
      for (int k = 0; k < kTaps; ++k) {
        for (int a = 0; a < 3; ++a) {
          tile_.taps[r].position[k][a] =
              median.position[a] + static_cast<Real>(options_.normal_step) * kTap[k][a];
        }
      }
      rays[count++] = r;
      if (count == kPerBatch) {
        NormalsOf(rays.data(), count, pictures);
        count = 0;
      }
    }
    if (count > 0) NormalsOf(rays.data(), count, pictures);
  }

  void NormalsOf(const int* rays, int count, RayRenderings<Real>* pictures) {
    for (int s = 0; s < kFieldBatch; ++s) {
      const Taps<Real>& taps = tile_.taps[rays[std::min(s / kTaps, count - 1)]];
      for (int a = 0; a < 3; ++a) batch_.position[a][s] = taps.position[s % kTaps][a];
    }
    field_.Evaluate(&batch_);
    for (int n = 0; n < count; ++n) {
      Taps<Real>& taps = tile_.taps[rays[n]];
      std::copy_n(batch_.features + n * kTaps * tile_.stride, kTaps * tile_.stride,
                  &tile_.tap_features[static_cast<std::size_t>(rays[n] * kTaps) * tile_.stride]);
      Real sum[3] = {0, 0, 0};
      for (int k = 0; k < kTaps; ++k) {
        for (int a = 0; a < 3; ++a) sum[a] += kTap[k][a] * batch_.raw[n * kTaps + k];
      }
      taps.slope = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
      if (!(taps.slope > Real(1e-6))) taps.slope = 0;
      const std::size_t at = static_cast<std::size_t>(tile_.first + rays[n]);
      for (int a = 0; a < 3; ++a) {
        taps.normal[a] = taps.slope > 0 ? -sum[a] / taps.slope : Real(0);
        pictures->normal[3 * at + a] = taps.normal[a];
      }
    }
  }

  struct Pending {
    int slot;  // of the tile's samples
    int ray;
  };

  const BasicRadianceField<Real>& field_;
  const OccupancyGrid& occupancy_;
  const VolumeRenderOptions& options_;
  Tile<Real>& tile_;
  std::vector<Pending> pending_;
  FieldBatch<Real> batch_;
};

// Computes dL/d(density, colour) of a ray's samples: with g_i = dL/dw_i, dL/dsigma_i = delta
// (T_{i+1} g_i - sum over j > i of w_j g_j).
template <typename Real>
void AddSampleGradients(const Tile<Real>& tile, int r, const RayRenderings<Real>& gradient,
                        GradientBatches<Real>* batches) {
  const Ray<Real>& ray = tile.ray[r];
  const std::size_t at = static_cast<std::size_t>(tile.first + r);
  const Real* color = &gradient.color[3 * at];
  const Real opacity = gradient.opacity[at], depth = gradient.depth[at];
  if (color[0] == 0 && color[1] == 0 && color[2] == 0 && opacity == 0 && depth == 0) return;
  const Sample<Real>* samples = &tile.samples[r * kMaxSamples];
  Real weight[kMaxSamples], after[kMaxSamples];  // w_i and T_{i+1}
  Real transmittance = 1;
  for (int k = 0; k < ray.count; ++k) {
    after[k] = transmittance * std::exp(-samples[k].density * ray.delta);
    weight[k] = transmittance - after[k];
    transmittance = after[k];
  }
  Real behind = 0;
  for (int k = ray.count - 1; k >= 0; --k) {
    const Sample<Real>& sample = samples[k];
    const Real of_weight = color[0] * sample.color[0] + color[1] * sample.color[1] +
                           color[2] * sample.color[2] + opacity + depth * sample.t;
    const int s =
        batches->Next(&tile.features[static_cast<std::size_t>(r * kMaxSamples + k) * tile.stride]);
    for (int a = 0; a < 3; ++a) batches->batch().position[a][s] = sample.position[a];
    batches->batch().density[s] = sample.density;
    batches->gradient().density[s] = ray.delta * (after[k] * of_weight - behind);
    for (int c = 0; c < 3; ++c) {
      batches->batch().color[c][s] = sample.color[c];
      batches->gradient().color[c][s] = weight[k] * color[c];
    }
    behind += weight[k] * of_weight;
  }
}

template <typename Real>
void AddNormalGradients(const Tile<Real>& tile, int r, const RayRenderings<Real>& gradient,
                        GradientBatches<Real>* batches) {
  const Taps<Real>& taps = tile.taps[r];
  if (taps.slope == 0) return;
  const Real* outer = &gradient.normal[3 * static_cast<std::size_t>(tile.first + r)];
  Real along = 0;
  for (int a = 0; a < 3; ++a) along += outer[a] * taps.normal[a];
  Real of_sum[3];
  for (int a = 0; a < 3; ++a) of_sum[a] = -(outer[a] - along * taps.normal[a]) / taps.slope;
  if (of_sum[0] == 0 && of_sum[1] == 0 && of_sum[2] == 0) return;
  for (int k = 0; k < kTaps; ++k) {
    const int s =
        batches->Next(&tile.tap_features[static_cast<std::size_t>(r * kTaps + k) * tile.stride]);
    Real raw = 0;
    for (int a = 0; a < 3; ++a) {
      batches->batch().position[a][s] = taps.position[k][a];
      raw += kTap[k][a] * of_sum[a];
    }
    batches->gradient().raw[s] = raw;
  }
}

}  // namespace

bool VolumeRenderOptions::IsValid(std::string* error) const {
  const char* fault = nullptr;
  if (max_samples < 1 || max_samples > kMaxSamples) fault = "max_samples must be 1 to 64";
  if (!(finest_step > 0.0)) fault = "finest_step must be positive";
  if (!(min_transmittance >= 0.0 && min_transmittance < 1.0)) {
    fault = "least_transmittance must be in [0, 1)";
  }
  if (!(normal_step > 0.0 && normal_step < 1.0)) fault = "normal_step must be in (0, 1)";
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

template <typename Real>
void RayRenderings<Real>::Resize(std::size_t rays) {
  color.assign(3 * rays, Real(0));
  opacity.assign(rays, Real(0));
  depth.assign(rays, Real(0));
  normal.assign(3 * rays, Real(0));
}

template <typename Real>
void FieldGradient<Real>::Prepare(const BasicRadianceField<Real>& field) {
  parts.resize(static_cast<std::size_t>(core::ThreadCount()));
  for (auto& part : parts) {
    if (part.size() != field.parameters().size()) part.assign(field.parameters().size(), Real(0));
  }
}

template <typename Real>
struct VolumeRenderer<Real>::Tiles {
  std::vector<Tile<Real>> tiles;
};

template <typename Real>
VolumeRenderer<Real>::VolumeRenderer(const VolumeRenderOptions& options)
    : options_(options), tiles_(std::make_unique<Tiles>()) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "volume rendering");
}

template <typename Real>
VolumeRenderer<Real>::~VolumeRenderer() = default;

template <typename Real>
void VolumeRenderer<Real>::Render(const BasicRadianceField<Real>& field,
                                  const OccupancyGrid& occupancy, const std::vector<FieldRay>& rays,
                                  std::uint64_t seed, RayRenderings<Real>* pictures) {
  for (const FieldRay& ray : rays) {
    if (!ray.origin.allFinite() || !ray.direction.allFinite() || ray.direction.isZero(0.0)) {
      throw core::Error("a ray is not finite, or has no direction", "volume rendering");
    }
  }
  pictures->Resize(rays.size());
  const int count = static_cast<int>(rays.size());
  tiles_->tiles.resize((rays.size() + kTileRays - 1) / kTileRays);
  const std::uint32_t mixed =
      Mixed(static_cast<std::uint32_t>(seed) ^ Mixed(static_cast<std::uint32_t>(seed >> 32)));
  core::ParallelFor(static_cast<int>(tiles_->tiles.size()), [&](int t) {
    Tile<Real>& tile = tiles_->tiles[t];
    tile.first = t * kTileRays;
    tile.rays = std::min(kTileRays, count - tile.first);
    TileRenderer<Real>(field, occupancy, options_, &tile).Render(rays, mixed, pictures);
  });
}

template <typename Real>
void VolumeRenderer<Real>::AddGradient(const BasicRadianceField<Real>& field,
                                       const RayRenderings<Real>& gradient,
                                       FieldGradient<Real>* sum) const {
  const std::vector<Tile<Real>>& tiles = tiles_->tiles;
  const std::size_t rays = tiles.empty() ? 0 : tiles.back().first + tiles.back().rays;
  if (gradient.color.size() != 3 * rays || gradient.opacity.size() != rays ||
      gradient.depth.size() != rays || gradient.normal.size() != 3 * rays) {
    throw core::Error("the gradient has another size than the rendering", "volume rendering");
  }
  sum->Prepare(field);
  // Each worker has its own tiles, by index: the sums do not depend on the workers' speed.
  const int workers = static_cast<int>(sum->parts.size());
  core::ParallelFor(workers, [&](int w) {
    GradientBatches<Real> batches(field, sum->parts[w].data());
    for (std::size_t t = w; t < tiles.size(); t += workers) {
      for (int r = 0; r < tiles[t].rays; ++r) {
        AddSampleGradients(tiles[t], r, gradient, &batches);
        if (!tiles[t].taps.empty()) AddNormalGradients(tiles[t], r, gradient, &batches);
      }
    }
    batches.Flush();
  });
}

template <typename Real>
std::int64_t VolumeRenderer<Real>::samples() const {
  std::int64_t sum = 0;
  for (const auto& tile : tiles_->tiles) sum += tile.evaluated;
  return sum;
}

template struct RayRenderings<float>;
template struct RayRenderings<double>;
template struct FieldGradient<float>;
template struct FieldGradient<double>;
template class VolumeRenderer<float>;
template class VolumeRenderer<double>;

}  // namespace simwright::asset_lift
