#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

// The quality of texture coordinates, for tests and benchmarks.
namespace simwright::atlas_quality {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The quality of texture coordinates on a texture of `size` pixels per side.
struct AtlasMeasures {
  double covered = 0.0;    // share of the texels whose centre lies in a triangle
  double spacing = 0.0;    // m: root mean square distance of neighbouring texels on the surface
  double stretch = 0.0;    // L2 stretch of Sander et al. 2001; 1: isometric, one density
  int charts = 0;          // connected through edges whose sides have the same coordinates
  double seams = 0.0;      // length of the edges inside the mesh that are cut, over all edges'
  int shared_texels = 0;   // texel centres strictly inside two triangles
  int nearest_charts = 0;  // texels between the two nearest charts, at most 2 margins
  int outside = 0;         // triangles that leave [0, 1]^2
  int reversed = 0;        // triangles of negative area
};

// In texels: a point nearer to an edge does not lie strictly inside the triangle.
inline constexpr double kEdge = 1e-3;
// In texels^2: triangles of less area cover no texel and are left out of the stretch.
inline constexpr double kNoTexels = 1e-9;

inline double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

struct AtlasView {
  const core::TriangleMesh& mesh;
  const std::vector<Eigen::Vector2f>& uvs;
  int size;

  Vector2d Texel(int triangle, int corner) const {
    return uvs[3 * static_cast<std::size_t>(triangle) + corner].cast<double>() * size;
  }
  int Triangles() const { return static_cast<int>(mesh.triangles.size()); }
};

// Sums the squared stretch: how far on the surface (m) a step of one texel leads.
inline void AddStretch(const AtlasView& view, AtlasMeasures* measures) {
  double area = 0.0, texels = 0.0, squares = 0.0;
  for (int t = 0; t < view.Triangles(); ++t) {
    const double surface = 0.5 * core::TriangleAreaVector(view.mesh, t).norm();
    const Vector2d p = view.Texel(t, 0), q = view.Texel(t, 1), r = view.Texel(t, 2);
    const double twice = Cross(q - p, r - p);
    measures->reversed += twice < 0.0;
    if (std::abs(twice) < kNoTexels) continue;
    const Eigen::Vector3i& c = view.mesh.triangles[t];
    const Vector3d u = view.mesh.vertices[c[1]] - view.mesh.vertices[c[0]];
    const Vector3d v = view.mesh.vertices[c[2]] - view.mesh.vertices[c[0]];
    const Vector3d along_s = (u * (r - p).y() - v * (q - p).y()) / twice;
    const Vector3d along_t = (v * (q - p).x() - u * (r - p).x()) / twice;
    squares += surface * 0.5 * (along_s.squaredNorm() + along_t.squaredNorm());
    area += surface;
    texels += 0.5 * std::abs(twice);
  }
  measures->spacing = std::sqrt(squares / area);
  measures->stretch = measures->spacing * std::sqrt(texels / area);
}

// Returns the chart of each triangle, and adds the number of charts and the seams.
inline std::vector<int> AddCharts(const AtlasView& view, AtlasMeasures* measures) {
  std::vector<int> root(view.Triangles());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> uses;
  for (int t = 0; t < view.Triangles(); ++t) {
    for (int k = 0; k < 3; ++k) {
      uses[std::minmax(view.mesh.triangles[t][k], view.mesh.triangles[t][(k + 1) % 3])]
          .emplace_back(t, k);
    }
  }
  const auto at = [&](int triangle, int vertex) {
    int corner = 0;
    while (view.mesh.triangles[triangle][corner] != vertex) ++corner;
    return view.uvs[3 * static_cast<std::size_t>(triangle) + corner];
  };
  double cut = 0.0, all = 0.0;
  for (const auto& [edge, sides] : uses) {
    const double length = (view.mesh.vertices[edge.first] - view.mesh.vertices[edge.second]).norm();
    if (sides.size() < 2) continue;
    all += length;
    bool whole = true;
    for (std::size_t s = 1; s < sides.size(); ++s) {
      const int one = sides[0].first, other = sides[s].first;
      const bool same = at(one, edge.first) == at(other, edge.first) &&
                        at(one, edge.second) == at(other, edge.second);
      if (same) root[find(other)] = find(one);
      whole = whole && same;
    }
    if (!whole) cut += length;
  }
  std::vector<int> chart(view.Triangles());
  for (int t = 0; t < view.Triangles(); ++t) {
    chart[t] = find(t);
    measures->charts += chart[t] == t;
  }
  measures->seams = all > 0.0 ? cut / all : 0.0;
  return chart;
}

// Returns the chart of each texel whose centre lies in a triangle, else -1.
inline std::vector<int> ChartOfTexel(const AtlasView& view, const std::vector<int>& chart,
                                     AtlasMeasures* measures) {
  std::vector<int> owner(static_cast<std::size_t>(view.size) * view.size, -1);
  std::vector<char> strictly(owner.size(), 0);
  for (int t = 0; t < view.Triangles(); ++t) {
    const Vector2d p[3] = {view.Texel(t, 0), view.Texel(t, 1), view.Texel(t, 2)};
    const double twice = Cross(p[1] - p[0], p[2] - p[0]);
    const double sign = twice < 0.0 ? -1.0 : 1.0;
    const Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Vector2d high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    measures->outside += low.minCoeff() < 0.0 || high.maxCoeff() > view.size;
    if (std::abs(twice) < kNoTexels) continue;
    for (int y = std::max(0, static_cast<int>(low.y() - 0.5)); y < view.size; ++y) {
      if (y + 0.5 > high.y()) break;
      for (int x = std::max(0, static_cast<int>(low.x() - 0.5)); x < view.size; ++x) {
        if (x + 0.5 > high.x()) break;
        double inside = INFINITY;
        for (int k = 0; k < 3; ++k) {
          const Vector2d edge = p[(k + 1) % 3] - p[k];
          const double side = sign * Cross(edge, Vector2d(x + 0.5, y + 0.5) - p[k]);
          inside = std::min(inside, side / std::max(edge.norm(), 1e-12));
        }
        if (inside < 0.0) continue;
        const std::size_t texel = static_cast<std::size_t>(y) * view.size + x;
        owner[texel] = chart[t];
        if (inside <= kEdge) continue;
        measures->shared_texels += strictly[texel];
        strictly[texel] = 1;
      }
    }
  }
  return owner;
}

// Returns the number of free texels between the nearest texels of two charts, at most `most`.
inline int FreeBetweenCharts(const std::vector<int>& owner, int size, int most) {
  int nearest = most + 1;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int own = owner[static_cast<std::size_t>(y) * size + x];
      if (own < 0) continue;
      for (int dy = 0; dy <= nearest && y + dy < size; ++dy) {
        for (int dx = -nearest; dx <= nearest; ++dx) {
          if (x + dx < 0 || x + dx >= size) continue;
          const int other = owner[static_cast<std::size_t>(y + dy) * size + x + dx];
          if (other < 0 || other == own) continue;
          nearest = std::min(nearest, std::max(dy, std::abs(dx)));
        }
      }
    }
  }
  return std::max(0, nearest - 1);
}

// Measures `uvs` (3M x 2) of a mesh whose vertices are welded; `margin`: texels kept free around
// each chart.
inline AtlasMeasures MeasureAtlas(const core::TriangleMesh& mesh,
                                  const std::vector<Eigen::Vector2f>& uvs, int size, int margin) {
  const AtlasView view{mesh, uvs, size};
  AtlasMeasures measures;
  AddStretch(view, &measures);
  const std::vector<int> chart = AddCharts(view, &measures);
  const std::vector<int> owner = ChartOfTexel(view, chart, &measures);
  const auto empty = std::count(owner.begin(), owner.end(), -1);
  measures.covered = 1.0 - static_cast<double>(empty) / static_cast<double>(owner.size());
  measures.nearest_charts = FreeBetweenCharts(owner, size, 2 * margin);
  return measures;
}

}  // namespace simwright::atlas_quality
