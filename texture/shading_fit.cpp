#include "texture/shading_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "core/random.h"
#include "render/light.h"

namespace simwright::texture {
namespace {

constexpr int kIterations = 15;
constexpr int kFree = 8;  // the coefficients beyond the first, which fixes the scale

using Light = Eigen::Matrix<float, 9, 1>;

// Two pixels whose colours are compared: residual = row . (1, x), of weight `weight`.
struct PixelPair {
  Eigen::Matrix<double, 9, 1> row;
  double weight;
};

// Draws pairs of usable pixels, every second one of near neighbours, and weighs them by how alike
// their chromaticities are.
std::vector<PixelPair> DrawPairs(const ObjectPixels& pixels, const std::vector<char>& usable,
                                 const DelightingOptions& options) {
  std::vector<int> candidates;
  for (int i = 0; i < pixels.count(); ++i) {
    if (usable[static_cast<std::size_t>(i)]) candidates.push_back(i);
  }
  std::vector<PixelPair> pairs;
  if (candidates.size() < 100) return pairs;
  core::Rng rng = core::StreamRng(options.seed, 0);
  const double reach = 0.15 * std::sqrt(static_cast<double>(candidates.size()));
  const auto draw = [&] {
    return candidates[static_cast<std::size_t>(
        core::UniformIndex(rng, static_cast<std::int64_t>(candidates.size())))];
  };
  // The weights of the light in a pixel's shading, relative to those of uniform light.
  const auto shading_row = [&](int i) {
    const auto p = static_cast<std::size_t>(i);
    const Light weights = render::IrradianceWeights(pixels.normal[p]);
    return Eigen::Matrix<double, 9, 1>((pixels.openness[p] / weights[0] * weights).cast<double>());
  };
  const double chroma = 0.5 / (options.chroma_scale * options.chroma_scale);
  for (int draws = 0; draws < 4 * options.pairs; ++draws) {
    if (static_cast<int>(pairs.size()) >= options.pairs) break;
    const int i = draw();
    int j = draw();
    if (draws % 2 == 0) {
      const int at = pixels.at[static_cast<std::size_t>(i)];
      const int x = at % pixels.width + static_cast<int>(std::lround(reach * core::Normal(rng)));
      const int y = at / pixels.width + static_cast<int>(std::lround(reach * core::Normal(rng)));
      if (x < 0 || y < 0 || x >= pixels.width || y >= pixels.height) continue;
      j = pixels.index[static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.width) +
                       static_cast<std::size_t>(x)];
      if (j < 0 || !usable[static_cast<std::size_t>(j)]) continue;
    }
    if (i == j) continue;
    const Eigen::Vector3f& a = pixels.color[static_cast<std::size_t>(i)];
    const Eigen::Vector3f& b = pixels.color[static_cast<std::size_t>(j)];
    const double apart = (Chromaticity(a) - Chromaticity(b)).squaredNorm();
    const double weight = std::exp(-chroma * apart);
    if (weight < 0.05) continue;
    const double p = Brightness(a), q = Brightness(b);
    pairs.push_back({(p * shading_row(j) - q * shading_row(i)) / (0.5 * (p + q)), weight});
  }
  return pairs;
}

}  // namespace

Eigen::Vector2f Chromaticity(const Eigen::Vector3f& color) {
  const float sum = std::max(1e-4f, color.sum());
  return color.head<2>() / sum;
}

float Brightness(const Eigen::Vector3f& color) {
  return std::max(1e-4f, color.sum() / 3.0f);
}

std::vector<float> ShadingOf(const ObjectPixels& pixels, const Light& light, float least) {
  std::vector<float> shading(pixels.normal.size());
  for (std::size_t i = 0; i < shading.size(); ++i) {
    const float value = pixels.openness[i] * light.dot(render::IrradianceWeights(pixels.normal[i]));
    // A smooth floor: half of `least` where the light fails altogether.
    shading[i] = value >= least ? value : least * (0.5f + 0.5f * std::max(0.0f, value) / least);
  }
  return shading;
}

Light FitGreyLight(const ObjectPixels& pixels, const std::vector<char>& usable,
                   const DelightingOptions& options) {
  const std::vector<PixelPair> pairs = DrawPairs(pixels, usable, options);
  Eigen::Matrix<double, kFree, 1> x = Eigen::Matrix<double, kFree, 1>::Zero();
  for (int iteration = 0; iteration < kIterations && !pairs.empty(); ++iteration) {
    Eigen::Matrix<double, kFree, kFree> normal = Eigen::Matrix<double, kFree, kFree>::Zero();
    Eigen::Matrix<double, kFree, 1> right = Eigen::Matrix<double, kFree, 1>::Zero();
    double total = 0.0;
    // The first iterations see all pairs, the later ones those of one albedo.
    const double scale = options.edge_scale * std::max(1.0, 4.0 * std::pow(0.75, iteration));
    for (const PixelPair& pair : pairs) {
      const auto free = pair.row.tail<kFree>();
      const double residual = pair.row[0] + free.dot(x);
      const double weight = pair.weight / (1.0 + residual * residual / (scale * scale));
      normal += weight * free * free.transpose();
      right -= weight * pair.row[0] * free;
      total += weight;
    }
    for (int k = 0; k < kFree; ++k) {
      normal(k, k) += total * (k < 3 ? options.band1_ridge : options.band2_ridge);
    }
    x = normal.ldlt().solve(right);
  }
  Light light;
  light << 1.0f, x.cast<float>();
  light /= render::IrradianceWeights(Eigen::Vector3f::UnitZ())[0];
  double sum = 0.0;
  for (const float shading : ShadingOf(pixels, light, 0.0f)) sum += shading;
  if (sum > 0.0) light *= static_cast<float>(pixels.count() / sum);
  return light;
}

}  // namespace simwright::texture
