#include "texture/painting/texel_map.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::texture {
namespace {

// A triangle of the atlas in texels, y down, with its affine map to barycentric coordinates.
struct AtlasTriangle {
  Eigen::Vector2f corner[3];
  float area = 0.0f;  // twice the signed area, texels^2

  AtlasTriangle(const std::vector<Eigen::Vector2f>& uvs, std::size_t triangle, int size) {
    const float scale = static_cast<float>(size);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f& uv = uvs[3 * triangle + k];
      corner[k] = {uv.x() * scale, (1.0f - uv.y()) * scale};
    }
    const Eigen::Vector2f ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    area = ab.x() * ac.y() - ab.y() * ac.x();
  }

  Eigen::Vector3f Coordinates(const Eigen::Vector2f& p) const {
    const Eigen::Vector2f ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    const Eigen::Vector2f ap = p - corner[0];
    const float v = (ap.x() * ac.y() - ap.y() * ac.x()) / area;
    const float w = (ab.x() * ap.y() - ab.y() * ap.x()) / area;
    return {1.0f - v - w, v, w};
  }

  // Calls visit(x, y, coordinates) for the texels whose centres the triangle covers.
  template <typename Visit>
  void ForTexels(int size, const Visit& visit) const {
    if (!(std::abs(area) > 1e-12f)) return;
    const Eigen::Vector2f low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
    const Eigen::Vector2f high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    const int x0 = std::max(0, static_cast<int>(low.x() - 0.5f));
    const int y0 = std::max(0, static_cast<int>(low.y() - 0.5f));
    const int x1 = std::min(size - 1, static_cast<int>(high.x() + 0.5f));
    const int y1 = std::min(size - 1, static_cast<int>(high.y() + 0.5f));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector3f at =
            Coordinates({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        if (at.minCoeff() >= -1e-4f) visit(x, y, at);
      }
    }
  }
};

// Returns the distance (texels) from a point to the triangle's outline, for points outside.
float OutlineDistance(const AtlasTriangle& triangle, const Eigen::Vector2f& p) {
  float nearest = 1e30f;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2f a = triangle.corner[k], ab = triangle.corner[(k + 1) % 3] - a;
    const float t = std::clamp((p - a).dot(ab) / std::max(1e-12f, ab.squaredNorm()), 0.0f, 1.0f);
    nearest = std::min(nearest, (a + t * ab - p).norm());
  }
  return nearest;
}

// Gives the texels around the mapped ones the nearest of their neighbours' triangles.
void GrowGutter(const std::vector<Eigen::Vector2f>& uvs, TexelMap* map) {
  const std::vector<std::int32_t> before = map->triangle;
  for (int y = 0; y < map->size; ++y) {
    for (int x = 0; x < map->size; ++x) {
      const std::size_t texel = map->Index(x, y);
      if (before[texel] >= 0) continue;
      const Eigen::Vector2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      float nearest = 1e30f;
      for (int n = 0; n < 9; ++n) {
        const int nx = x + n % 3 - 1, ny = y + n / 3 - 1;
        if (nx < 0 || ny < 0 || nx >= map->size || ny >= map->size) continue;
        const std::int32_t candidate = before[map->Index(nx, ny)];
        if (candidate < 0 || candidate == map->triangle[texel]) continue;
        const AtlasTriangle triangle(uvs, static_cast<std::size_t>(candidate), map->size);
        const float distance = OutlineDistance(triangle, centre);
        if (distance >= nearest) continue;
        nearest = distance;
        map->triangle[texel] = candidate;
        map->barycentric[texel] = triangle.Coordinates(centre);
      }
    }
  }
}

void RequireUvCount(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs) {
  if (uvs.size() != 3 * mesh.triangles.size()) {
    throw core::Error("a texture needs texture coordinates for each corner");
  }
}

}  // namespace

Eigen::Vector3d TexelMap::Position(const core::TriangleMesh& mesh, std::size_t texel) const {
  const Eigen::Vector3i& corners = mesh.triangles[static_cast<std::size_t>(triangle[texel])];
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    point += static_cast<double>(barycentric[texel][k]) * mesh.vertices[corners[k]];
  }
  return point;
}

Eigen::Vector3f TexelMap::OnTriangle(std::size_t texel) const {
  const Eigen::Vector3f clamped = barycentric[texel].cwiseMax(0.0f);
  return clamped / std::max(1e-12f, clamped.sum());
}

TexelMap MakeTexelMap(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                      int size) {
  RequireUvCount(mesh, uvs);
  if (size < 1) throw core::Error("a texture needs at least one texel");
  TexelMap map;
  map.size = size;
  const std::size_t count = static_cast<std::size_t>(size) * size;
  map.triangle.assign(count, -1);
  map.barycentric.assign(count, Eigen::Vector3f::Zero());
  map.inside.assign(count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    AtlasTriangle(uvs, t, size).ForTexels(size, [&](int x, int y, const Eigen::Vector3f& at) {
      const std::size_t texel = map.Index(x, y);
      map.triangle[texel] = static_cast<std::int32_t>(t);
      map.barycentric[texel] = at;
      map.inside[texel] = 1;
    });
  }
  for (int ring = 0; ring < kGutter; ++ring) GrowGutter(uvs, &map);
  return map;
}

bool UvsAreUnique(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                  double overlap) {
  if (uvs.size() != 3 * mesh.triangles.size() || mesh.empty()) return false;
  constexpr int kSize = 512;
  constexpr float kOutside = 1e-4f;
  double area = 0.0, bare_area = 0.0;  // of all triangles, and of those without a part of the atlas
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f& uv = uvs[3 * t + k];
      if (!(uv.minCoeff() >= -kOutside) || !(uv.maxCoeff() <= 1.0f + kOutside)) return false;
    }
    const double own = core::TriangleAreaVector(mesh, static_cast<int>(t)).norm();
    area += own;
    if (std::abs(AtlasTriangle(uvs, t, kSize).area) < 1e-6f) bare_area += own;
  }
  if (bare_area > 1e-6 * area) return false;
  // Triangles are drawn a little smaller, so that neighbours share no texel.
  std::vector<std::uint8_t> claims(static_cast<std::size_t>(kSize) * kSize, 0);
  double covered = 0.0, twice = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    AtlasTriangle(uvs, t, kSize).ForTexels(kSize, [&](int x, int y, const Eigen::Vector3f& at) {
      if (at.minCoeff() < 1e-3f) return;
      std::uint8_t& claim = claims[static_cast<std::size_t>(y) * kSize + x];
      covered += claim == 0;
      twice += claim == 1;
      claim = static_cast<std::uint8_t>(std::min(2, claim + 1));
    });
  }
  return twice <= overlap * std::max(1.0, covered);
}

void FillBetweenCharts(const TexelMap& map, int rings, core::Image* image) {
  std::vector<std::uint8_t> filled(map.count());
  for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = map.triangle[i] >= 0;
  const int channels = image->channels;
  std::vector<double> mean(static_cast<std::size_t>(channels), 0.0);
  double count = 0.0;
  for (std::size_t i = 0; i < filled.size(); ++i) {
    if (!filled[i]) continue;
    ++count;
    for (int c = 0; c < channels; ++c) mean[c] += image->pixels[channels * i + c];
  }
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<std::uint8_t> before = filled;
    for (int y = 0; y < map.size; ++y) {
      for (int x = 0; x < map.size; ++x) {
        if (before[map.Index(x, y)]) continue;
        int sum[4] = {0, 0, 0, 0}, found = 0;
        for (int n = 0; n < 9; ++n) {
          const int nx = x + n % 3 - 1, ny = y + n / 3 - 1;
          if (nx < 0 || ny < 0 || nx >= map.size || ny >= map.size) continue;
          if (!before[map.Index(nx, ny)]) continue;
          for (int c = 0; c < channels; ++c) sum[c] += image->At(nx, ny)[c];
          ++found;
        }
        if (found == 0) continue;
        for (int c = 0; c < channels; ++c) {
          image->At(x, y)[c] = static_cast<std::uint8_t>(sum[c] / found);
        }
        filled[map.Index(x, y)] = 1;
      }
    }
  }
  for (std::size_t i = 0; i < filled.size() && count > 0.0; ++i) {
    if (filled[i]) continue;
    for (int c = 0; c < channels; ++c) {
      image->pixels[channels * i + c] = static_cast<std::uint8_t>(mean[c] / count);
    }
  }
}

}  // namespace simwright::texture
