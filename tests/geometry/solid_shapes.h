#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "geometry/convex_hull.h"
#include "geometry/isosurface.h"

// Closed solids of known volume, hollows and holes, for tests and benchmarks.
namespace simwright::shapes {

using core::TriangleMesh;
using Eigen::Vector2d;
using Eigen::Vector3d;

inline constexpr double kPi = std::numbers::pi;

// Removes the vertices that no triangle uses.
inline TriangleMesh Compacted(const TriangleMesh& mesh) {
  TriangleMesh out;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (Eigen::Vector3i t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (index[t[k]] < 0) {
        index[t[k]] = static_cast<int>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[t[k]]);
      }
      t[k] = index[t[k]];
    }
    out.triangles.push_back(t);
  }
  return out;
}

// Returns the solid of revolution of the profile (r, z), a closed counter-clockwise polygon with r
// >= 0, about z. It closes where the profile touches the axis.
inline TriangleMesh Revolved(const std::vector<Vector2d>& profile, int segments) {
  TriangleMesh mesh;
  const int n = static_cast<int>(profile.size());
  std::vector<int> first(n);
  for (int i = 0; i < n; ++i) {
    first[i] = static_cast<int>(mesh.vertices.size());
    const int copies = profile[i].x() == 0.0 ? 1 : segments;
    for (int s = 0; s < copies; ++s) {
      const double angle = 2.0 * kPi * s / segments;
      mesh.vertices.emplace_back(profile[i].x() * std::cos(angle), profile[i].x() * std::sin(angle),
                                 profile[i].y());
    }
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    const bool axis_i = profile[i].x() == 0.0, axis_j = profile[j].x() == 0.0;
    if (axis_i && axis_j) continue;
    for (int s = 0; s < segments; ++s) {
      const int t = (s + 1) % segments;
      const int a = first[i] + (axis_i ? 0 : s), b = first[i] + (axis_i ? 0 : t);
      const int c = first[j] + (axis_j ? 0 : s), d = first[j] + (axis_j ? 0 : t);
      if (!axis_i) mesh.triangles.emplace_back(a, b, c);
      if (!axis_j) mesh.triangles.emplace_back(c, b, d);
    }
  }
  return mesh;
}

inline TriangleMesh Sphere(double radius, int segments) {
  std::vector<Vector2d> profile;
  const int rings = segments / 2;
  for (int i = 0; i <= rings; ++i) {
    const double angle = -kPi / 2 + kPi * i / rings;
    const bool pole = i == 0 || i == rings;
    profile.emplace_back(pole ? 0.0 : radius * std::cos(angle), radius * std::sin(angle));
  }
  return Revolved(profile, segments);
}

// Splits each triangle into four, with new corners at its edges' midpoints.
inline TriangleMesh Subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), fine.vertices.size());
    if (fresh) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return at->second;
  };
  for (const auto& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.emplace_back(t[0], ab, ca);
    fine.triangles.emplace_back(ab, t[1], bc);
    fine.triangles.emplace_back(ca, bc, t[2]);
    fine.triangles.emplace_back(ab, bc, ca);
  }
  return fine;
}

// Returns a sphere of 20 * 4^levels faces with radius 1.
inline TriangleMesh Icosphere(int levels) {
  const double g = std::numbers::phi;
  std::vector<Vector3d> points;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      for (int k = 0; k < 3; ++k) {
        Vector3d p = Vector3d::Zero();
        p[k] = s;
        p[(k + 1) % 3] = t;
        points.push_back(p.normalized());
      }
    }
  }
  TriangleMesh ball = geometry::ConvexHull(points);
  for (int i = 0; i < levels; ++i) {
    ball = Subdivided(ball);
    for (Vector3d& v : ball.vertices) v.normalize();
  }
  return ball;
}

inline TriangleMesh Cylinder(double radius, double height, int segments) {
  return Revolved({{0.0, 0.0}, {radius, 0.0}, {radius, height}, {0.0, height}}, segments);
}

inline TriangleMesh Cone(double radius, double height, int segments) {
  return Revolved({{0.0, 0.0}, {radius, 0.0}, {0.0, height}}, segments);
}

// Returns a torus about z, the tube's centre at distance `major` from the axis.
inline TriangleMesh Torus(double major, double minor, int segments, int tube_segments) {
  std::vector<Vector2d> profile;
  for (int i = 0; i < tube_segments; ++i) {
    const double angle = 2.0 * kPi * i / tube_segments;
    profile.emplace_back(major + minor * std::cos(angle), minor * std::sin(angle));
  }
  return Revolved(profile, segments);
}

// Returns a cup without a handle: wall and floor of thickness `wall`, standing on z = 0.
inline TriangleMesh Cup(double radius, double height, double wall, int segments) {
  return Revolved({{0.0, 0.0},
                   {radius, 0.0},
                   {radius, height},
                   {radius - wall, height},
                   {radius - wall, wall},
                   {0.0, wall}},
                  segments);
}

// Returns the lower half of a spherical shell.
inline TriangleMesh Bowl(double radius, double wall, int segments) {
  std::vector<Vector2d> profile;
  const int rings = segments / 4;
  for (int i = 0; i <= rings; ++i) {
    const double a = -kPi / 2 + kPi / 2 * i / rings;
    profile.emplace_back(i == 0 ? 0.0 : radius * std::cos(a), radius * std::sin(a));
  }
  for (int i = rings; i >= 0; --i) {
    const double a = -kPi / 2 + kPi / 2 * i / rings;
    profile.emplace_back(i == 0 ? 0.0 : (radius - wall) * std::cos(a),
                         (radius - wall) * std::sin(a));
  }
  return Revolved(profile, segments);
}

// Returns the union of axis-aligned boxes, which may overlap, on the grid of all their sides.
inline TriangleMesh BoxUnion(const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::array<std::vector<double>, 3> at;
  for (int k = 0; k < 3; ++k) {
    std::set<double> values;
    for (const auto& box : boxes) {
      values.insert(box.min()[k]);
      values.insert(box.max()[k]);
    }
    at[k].assign(values.begin(), values.end());
  }
  const auto filled = [&](int x, int y, int z) {
    const std::array<int, 3> cell{x, y, z};
    Vector3d p;
    for (int k = 0; k < 3; ++k) {
      if (cell[k] < 0 || cell[k] + 1 >= static_cast<int>(at[k].size())) return false;
      p[k] = 0.5 * (at[k][cell[k]] + at[k][cell[k] + 1]);
    }
    return std::any_of(boxes.begin(), boxes.end(), [&](const auto& b) { return b.contains(p); });
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](std::array<int, 3> g) {
    const auto [entry, added] = index.try_emplace(g, static_cast<int>(mesh.vertices.size()));
    if (added) mesh.vertices.emplace_back(at[0][g[0]], at[1][g[1]], at[2][g[2]]);
    return entry->second;
  };
  for (int x = 0; x + 1 < static_cast<int>(at[0].size()); ++x) {
    for (int y = 0; y + 1 < static_cast<int>(at[1].size()); ++y) {
      for (int z = 0; z + 1 < static_cast<int>(at[2].size()); ++z) {
        if (!filled(x, y, z)) continue;
        for (int k = 0; k < 3; ++k) {
          for (const int side : {0, 1}) {
            std::array<int, 3> next{x, y, z};
            next[k] += side ? 1 : -1;
            if (filled(next[0], next[1], next[2])) continue;
            std::array<std::array<int, 3>, 4> corner;
            for (int c = 0; c < 4; ++c) {
              corner[c] = {x, y, z};
              corner[c][k] += side;
              corner[c][(k + 1) % 3] += c == 1 || c == 2;
              corner[c][(k + 2) % 3] += c >= 2;
            }
            if (!side) std::swap(corner[1], corner[3]);
            const int a = vertex(corner[0]), b = vertex(corner[1]), c = vertex(corner[2]),
                      d = vertex(corner[3]);
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
          }
        }
      }
    }
  }
  return mesh;
}

inline Eigen::AlignedBox3d BoxAt(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {Vector3d(x0, y0, z0), Vector3d(x1, y1, z1)};
}

// Returns a box with one corner at the origin.
inline TriangleMesh Box(double x, double y, double z) {
  return BoxUnion({BoxAt(0, 0, 0, x, y, z)});
}

// Returns a box of twelve triangles between two corners.
inline TriangleMesh Box(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.vertices.emplace_back(c & 1 ? high.x() : low.x(), c & 2 ? high.y() : low.y(),
                               c & 4 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Returns the extrusion along z of a star-shaped polygon (about its origin).
inline TriangleMesh Prism(const std::vector<Vector2d>& polygon, double height) {
  TriangleMesh mesh;
  const int n = static_cast<int>(polygon.size());
  for (const double z : {0.0, height}) {
    for (const Vector2d& p : polygon) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  mesh.vertices.emplace_back(0.0, 0.0, 0.0);
  mesh.vertices.emplace_back(0.0, 0.0, height);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.emplace_back(i, j, n + j);
    mesh.triangles.emplace_back(i, n + j, n + i);
    mesh.triangles.emplace_back(2 * n, j, i);
    mesh.triangles.emplace_back(2 * n + 1, n + i, n + j);
  }
  return mesh;
}

// Returns the solid where `distance` (m, about a signed distance) is negative, on a grid of `cell`.
inline TriangleMesh Implicit(const Eigen::AlignedBox3d& box, double cell,
                             const std::function<double(const Vector3d&)>& distance) {
  geometry::ScalarGrid grid;
  grid.cell = cell;
  grid.origin = box.min() - Vector3d::Constant(2.3 * cell);
  const Eigen::Array3d nodes = (box.sizes().array() / cell).ceil() + 6.0;
  grid.nx = static_cast<int>(nodes[0]);
  grid.ny = static_cast<int>(nodes[1]);
  grid.nz = static_cast<int>(nodes[2]);
  grid.values.resize(static_cast<std::size_t>(grid.nx) * grid.ny * grid.nz);
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        grid.values[grid.Index(i, j, k)] =
            static_cast<float>(distance(grid.origin + cell * Vector3d(i, j, k)));
      }
    }
  }
  return geometry::ExtractIsosurface(grid, 0.0f);
}

// Returns a mug 95 mm high and 80 mm wide on z = 0, wall 4 mm, floor 5 mm, with a handle at +x: an
// upright elliptical ring in the plane y = 0, its centre at x = 42 mm, z = 48 mm, half axes 27 and
// 30 mm, 8 mm thick, so that the hole between it and the body is 19 mm wide.
inline TriangleMesh Mug(double cell) {
  const auto distance = [](const Vector3d& p) {
    const double r = std::hypot(p.x(), p.y());
    const double outer = std::max({r - 0.040, p.z() - 0.095, -p.z()});
    const double hollow = std::max(r - 0.036, 0.005 - p.z());
    const double body = std::max(outer, -hollow);
    const double u = (p.x() - 0.042) / 0.027, w = (p.z() - 0.048) / 0.030;
    const double along = (std::hypot(u, w) - 1.0) * 0.0285;
    const double ring = std::max(std::hypot(along, p.y()) - 0.004, 0.038 - r);
    return std::min(body, ring);
  };
  return Implicit(BoxAt(-0.041, -0.041, -0.001, 0.075, 0.041, 0.096), cell, distance);
}

}  // namespace simwright::shapes
