#include "asset_lift/radiance_field/occupancy_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace simwright::asset_lift {

OccupancyGrid::OccupancyGrid() : allowed_(kSide * kSide, ~std::uint64_t{0}), occupied_(allowed_) {}

void OccupancyGrid::Restrict(const std::vector<std::uint8_t>& allowed) {
  if (allowed.size() != std::size_t{kSide} * kSide * kSide) {
    throw core::Error("an occupancy grid's restriction must have 64^3 values", "occupancy grid");
  }
  for (std::size_t row = 0; row < allowed_.size(); ++row) {
    std::uint64_t bits = 0;
    for (int i = 0; i < kSide; ++i) {
      bits |= static_cast<std::uint64_t>(allowed[row * kSide + i] != 0) << i;
    }
    allowed_[row] &= bits;
    occupied_[row] &= bits;
  }
}

template <typename Real>
void OccupancyGrid::Update(const BasicRadianceField<Real>& field, const OccupancyOptions& options,
                           std::uint64_t seed) {
  density_.resize(std::size_t{kSide} * kSide * kSide, 0.0f);
  std::vector<double> slice_sum(kSide, 0.0);
  const auto keep = static_cast<float>(options.decay);
  core::ParallelFor(kSide, [&](int k) {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(k));
    FieldBatch<Real> batch;
    for (int j = 0; j < kSide; ++j) {
      const int row = j + kSide * k;
      if (allowed_[row] == 0) continue;
      static_assert(kSide == kFieldBatch);
      for (int i = 0; i < kSide; ++i) {
        const std::uint64_t bits = rng();  // 21 bits per axis
        const auto at = [&](int cell, int shift) {
          const double within = static_cast<double>((bits >> shift) & 0x1fffff) * 0x1p-21;
          return static_cast<Real>((cell + within) * kCell - 1.0);
        };
        batch.position[0][i] = at(i, 0);
        batch.position[1][i] = at(j, 21);
        batch.position[2][i] = at(k, 42);
      }
      field.Evaluate(&batch);
      float* density = &density_[static_cast<std::size_t>(row) * kSide];
      for (int i = 0; i < kSide; ++i) {
        if (((allowed_[row] >> i) & 1) == 0) continue;
        density[i] = std::max(keep * density[i], static_cast<float>(batch.density[i]));
        slice_sum[k] += density[i];
      }
    }
  });
  double sum = 0.0;
  std::int64_t cells = 0;
  for (const double s : slice_sum) sum += s;
  for (const std::uint64_t bits : allowed_) cells += std::popcount(bits);
  const double mean = cells > 0 ? sum / static_cast<double>(cells) : 0.0;
  const auto limit = static_cast<float>(std::min(options.threshold / kCell, mean));
  for (std::size_t row = 0; row < allowed_.size(); ++row) {
    std::uint64_t bits = 0;
    for (int i = 0; i < kSide; ++i) {
      bits |= static_cast<std::uint64_t>(density_[row * kSide + i] >= limit) << i;
    }
    occupied_[row] = bits & allowed_[row];
  }
}

template void OccupancyGrid::Update(const BasicRadianceField<float>&, const OccupancyOptions&,
                                    std::uint64_t);
template void OccupancyGrid::Update(const BasicRadianceField<double>&, const OccupancyOptions&,
                                    std::uint64_t);

bool OccupancyGrid::Clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         double* near, double* far) const {
  double from = *near, to = *far;
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == 0.0) {
      if (std::abs(origin[a]) > 1.0) return false;
      continue;
    }
    const double s = (-1.0 - origin[a]) / direction[a], t = (1.0 - origin[a]) / direction[a];
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  if (!(from < to)) return false;
  const double length = (to - from) * direction.norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / (0.5 * kCell))));
  const double step = (to - from) / steps;
  int first = -1, last = -1;
  Eigen::Vector3d at = origin + (from + 0.5 * step) * direction;
  const Eigen::Vector3d move = step * direction;
  for (int n = 0; n < steps; ++n, at += move) {
    if (!Occupied(at.x(), at.y(), at.z())) continue;
    if (first < 0) first = n;
    last = n;
  }
  if (first < 0) return false;
  *near = std::max(from, from + (first - 1) * step);
  *far = std::min(to, from + (last + 2) * step);
  return true;
}

double OccupancyGrid::OccupiedShare() const {
  std::int64_t cells = 0;
  for (const std::uint64_t bits : occupied_) cells += std::popcount(bits);
  return static_cast<double>(cells) / (static_cast<double>(kSide) * kSide * kSide);
}

}  // namespace simwright::asset_lift
