#include "texture/painting/surface_fill.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/parallel.h"

namespace simwright::texture {
namespace {

constexpr int kLevels = 12;

// Sums of colours (x, y, z) and their number (w) by cell of one grid.
using ColorGrid = std::unordered_map<std::uint64_t, Eigen::Vector4f>;

std::uint64_t CellKey(const Eigen::Vector3i& cell) {
  constexpr int kOffset = 1 << 20;
  const auto part = [](int c) { return static_cast<std::uint64_t>(c + kOffset) & 0x1fffff; };
  return part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z());
}

// Returns the weighted sum of the eight cells around `place` (in cells), colours and weight.
Eigen::Vector4f Around(const ColorGrid& grid, const Eigen::Vector3f& place) {
  const Eigen::Vector3f shifted = place - Eigen::Vector3f::Constant(0.5f);
  const Eigen::Vector3i low = shifted.array().floor().cast<int>();
  const Eigen::Vector3f share = shifted - low.cast<float>();
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const auto found = grid.find(CellKey(low + step));
    if (found == grid.end()) continue;
    float weight = 1.0f;
    for (int k = 0; k < 3; ++k) weight *= step[k] ? share[k] : 1.0f - share[k];
    Eigen::Vector4f value = found->second / found->second.w();
    sum += weight * value;
  }
  return sum;
}

}  // namespace

void FillUnknownColors(const std::vector<Eigen::Vector3f>& points,
                       const std::vector<std::uint8_t>& known, float spacing,
                       std::vector<Eigen::Vector3f>* colors) {
  if (std::find(known.begin(), known.end(), 1) == known.end()) return;
  if (std::find(known.begin(), known.end(), 0) == known.end()) return;
  std::vector<ColorGrid> grids(kLevels);
  const auto place = [&](std::size_t i, int level) {
    return Eigen::Vector3f(points[i] / std::ldexp(spacing, level));
  };
  for (int level = 0; level < kLevels; ++level) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!known[i]) continue;
      const Eigen::Vector3i cell = place(i, level).array().floor().cast<int>();
      Eigen::Vector4f value;
      value << (*colors)[i], 1.0f;
      const auto [at, is_new] = grids[level].try_emplace(CellKey(cell), value);
      if (!is_new) at->second += value;
    }
  }
  constexpr int kChunk = 4096;
  const int chunks = static_cast<int>((points.size() + kChunk - 1) / kChunk);
  core::ParallelFor(chunks, [&](int chunk) {
    const std::size_t end = std::min(points.size(), static_cast<std::size_t>(chunk + 1) * kChunk);
    for (std::size_t i = static_cast<std::size_t>(chunk) * kChunk; i < end; ++i) {
      if (known[i]) continue;
      // Finer grids cover first; coarser ones fill the rest of the weight.
      Eigen::Vector3f color = Eigen::Vector3f::Zero();
      float covered = 0.0f;
      for (int level = 0; level < kLevels && covered < 0.999f; ++level) {
        const Eigen::Vector4f sum = Around(grids[level], place(i, level));
        if (!(sum.w() > 1e-4f)) continue;
        const float weight = (1.0f - covered) * std::min(1.0f, sum.w());
        color += weight * sum.head<3>() / sum.w();
        covered += weight;
      }
      if (covered > 0.0f) (*colors)[i] = color / covered;
    }
  });
}

}  // namespace simwright::texture
