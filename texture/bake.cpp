#include "texture/bake.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::texture {
namespace {

// Returns the barycentric coordinates of p in (a, b, c); sum 1, negative outside.
Eigen::Vector3f Barycentric(const Eigen::Vector2f& p, const Eigen::Vector2f& a,
                            const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const Eigen::Vector2f ab = b - a, ac = c - a, ap = p - a;
  const float area = ab.x() * ac.y() - ab.y() * ac.x();
  if (std::abs(area) < 1e-20f) return {-1, -1, -1};
  const float v = (ap.x() * ac.y() - ap.y() * ac.x()) / area;
  const float w = (ab.x() * ap.y() - ab.y() * ap.x()) / area;
  return {1.0f - v - w, v, w};
}

// Returns the triangle that covers each texel, or -1. Texel rows run downwards.
std::vector<int> OwnerMap(const std::vector<Eigen::Vector2f>& uvs, int size) {
  std::vector<int> owner(static_cast<size_t>(size) * size, -1);
  const float scale = static_cast<float>(size);
  for (size_t t = 0; 3 * t < uvs.size(); ++t) {
    Eigen::Vector2f p[3];
    for (size_t k = 0; k < 3; ++k) {
      p[k] = {uvs[3 * t + k].x() * scale, (1.0f - uvs[3 * t + k].y()) * scale};
    }
    const Eigen::Vector2f low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Eigen::Vector2f high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const int x0 = std::max(0, static_cast<int>(low.x() - 0.5f));
    const int y0 = std::max(0, static_cast<int>(low.y() - 0.5f));
    for (int y = y0; y <= std::min(size - 1, static_cast<int>(high.y() + 0.5f)); ++y) {
      for (int x = x0; x <= std::min(size - 1, static_cast<int>(high.x() + 0.5f)); ++x) {
        const Eigen::Vector2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        if (Barycentric(centre, p[0], p[1], p[2]).minCoeff() >= -1e-4f) {
          owner[static_cast<size_t>(y) * size + x] = static_cast<int>(t);
        }
      }
    }
  }
  return owner;
}

// Fills one ring of texels around the filled ones with the mean of their filled neighbours.
void DilateOnce(core::Image* image, std::vector<std::uint8_t>* filled) {
  const std::vector<std::uint8_t> before = *filled;
  const int size = image->width;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      if (before[static_cast<size_t>(y) * size + x]) continue;
      int sum[3] = {0, 0, 0}, count = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int nx = x + dx, ny = y + dy;
          if (nx < 0 || ny < 0 || nx >= size || ny >= size) continue;
          if (!before[static_cast<size_t>(ny) * size + nx]) continue;
          for (int c = 0; c < 3; ++c) sum[c] += image->At(nx, ny)[c];
          ++count;
        }
      }
      if (count == 0) continue;
      for (int c = 0; c < 3; ++c) {
        image->At(x, y)[c] = static_cast<std::uint8_t>(sum[c] / count);
      }
      (*filled)[static_cast<size_t>(y) * size + x] = 1;
    }
  }
}

void FillWithMean(const std::vector<std::uint8_t>& filled, core::Image* image) {
  double sum[3] = {0, 0, 0};
  double count = 0.0;
  for (size_t i = 0; i < filled.size(); ++i) {
    if (!filled[i]) continue;
    for (int c = 0; c < 3; ++c) sum[c] += image->pixels[3 * i + c];
    ++count;
  }
  for (size_t i = 0; i < filled.size() && count > 0.0; ++i) {
    if (filled[i]) continue;
    for (int c = 0; c < 3; ++c) {
      image->pixels[3 * i + c] = static_cast<std::uint8_t>(sum[c] / count);
    }
  }
}

}  // namespace

core::Image BakeTexture(const core::TriangleMesh& mesh,
                        const std::vector<Eigen::Vector2f>& corner_uvs, int size, int dilation,
                        const std::function<Eigen::Vector3f(const SurfacePoint&)>& color) {
  if (corner_uvs.size() != 3 * mesh.triangles.size() || size < 1) {
    throw core::Error("baking needs texture coordinates for each corner");
  }
  const std::vector<int> owner = OwnerMap(corner_uvs, size);
  core::Image image(size, size, 3);
  std::vector<std::uint8_t> filled(owner.size(), 0);
  core::ParallelFor(size, [&](int y) {
    for (int x = 0; x < size; ++x) {
      const size_t at = static_cast<size_t>(y) * size + x;
      if (owner[at] < 0) continue;
      SurfacePoint point;
      point.triangle = owner[at];
      const size_t t = static_cast<size_t>(point.triangle);
      const Eigen::Vector2f uv((static_cast<float>(x) + 0.5f) / static_cast<float>(size),
                               1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size));
      point.barycentric =
          Barycentric(uv, corner_uvs[3 * t], corner_uvs[3 * t + 1], corner_uvs[3 * t + 2])
              .cwiseMax(0.0f);
      point.barycentric /= std::max(1e-12f, point.barycentric.sum());
      point.position.setZero();
      for (int k = 0; k < 3; ++k) {
        point.position += point.barycentric[k] * mesh.vertices[mesh.triangles[t][k]];
      }
      point.normal = core::TriangleAreaVector(mesh, point.triangle).stableNormalized();
      const Eigen::Vector3f rgb = color(point);
      for (int c = 0; c < 3; ++c) {
        image.At(x, y)[c] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(rgb[c], 0.0f, 1.0f)));
      }
      filled[at] = 1;
    }
  });
  for (int i = 0; i < dilation; ++i) DilateOnce(&image, &filled);
  FillWithMean(filled, &image);
  return image;
}

}  // namespace simwright::texture
