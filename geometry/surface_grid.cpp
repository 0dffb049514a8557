#include "geometry/surface_grid.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kPieceCells = 6.0;  // length at which most of a slanted piece's AABB is still in
                                     // the band
constexpr int kGridSlab = 8;         // layers per task
// Rounding of a coordinate in cells is below 1e-12; a line this close to a triangle's edge counts
// as a crossing, so that none slips between two neighbours.
constexpr double kSlack = 1e-7;

constexpr int kLanes = 4;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

Lanes Lesser(Lanes a, Lanes b) {
  return a < b ? a : b;
}

// Computes squared distances from a row of nodes to one triangle, several at a time. In cells,
// relative to the triangle's corner, so that single precision is accurate to 1e-6 of a cell.
struct LaneTriangle {
  LaneTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) : corner(a) {
    normal = (b - a).cross(c - a);
    const double length = normal.norm();
    normal = length > 0.0 ? Vector3d(normal / length) : Vector3d::Zero();
    offset = normal.dot(a);
    flat = length > 0.0;
    const std::array<Vector3d, 3> corners = {a, b, c};
    for (int e = 0; e < 3; ++e) {
      start[e] = (corners[e] - a).cast<float>();
      const Vector3d along = corners[(e + 1) % 3] - corners[e];
      edge[e] = along.cast<float>();
      const double squared = along.squaredNorm();
      inverse[e] = squared > 0.0 ? static_cast<float>(1.0 / squared) : 0.0f;
      inward[e] = normal.cross(along).cast<float>();
    }
  }

  void SquaredDistances(int i, int j, int k, std::array<float, kLanes>* squared) const {
    const Lanes step = {0.0f, 1.0f, 2.0f, 3.0f};
    const Lanes x = step + static_cast<float>(i - corner.x());
    const float y = static_cast<float>(j - corner.y());
    const float z = static_cast<float>(k - corner.z());
    const Lanes zero = {};
    const Lanes one = zero + 1.0f;
    Lanes nearest = zero + 1e30f;
    Lanes inside = one;
    for (int e = 0; e < 3; ++e) {
      const Lanes px = x - start[e].x();
      const float py = y - start[e].y();
      const float pz = z - start[e].z();
      const Lanes side = px * inward[e].x() + (py * inward[e].y() + pz * inward[e].z());
      inside = side < zero ? zero : inside;
      Lanes t = (px * edge[e].x() + (py * edge[e].y() + pz * edge[e].z())) * inverse[e];
      t = t < zero ? zero : Lesser(t, one);
      const Lanes dx = px - t * edge[e].x();
      const Lanes dy = py - t * edge[e].y();
      const Lanes dz = pz - t * edge[e].z();
      nearest = Lesser(nearest, dx * dx + dy * dy + dz * dz);
    }
    if (flat) {
      const Lanes above = x * static_cast<float>(normal.x()) +
                          (y * static_cast<float>(normal.y()) + z * static_cast<float>(normal.z()));
      nearest = inside > zero ? above * above : nearest;
    }
    for (int lane = 0; lane < kLanes; ++lane) (*squared)[lane] = nearest[lane];
  }

  Vector3d corner;
  Vector3d normal;
  double offset = 0.0;
  bool flat = true;
  std::array<Eigen::Vector3f, 3> start, edge, inward;
  std::array<float, 3> inverse{};
};

}  // namespace

std::array<int, 3> SurfaceGrid::Size(const core::TriangleMesh& mesh, double cell, double band,
                                     int margin) {
  const Vector3d extent = core::Bounds(mesh).sizes();
  std::array<int, 3> size;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<int>(std::min(
        1e6, std::ceil(extent[axis] / cell) + 2.0 * (std::ceil(band / cell) + margin) + 2));
  }
  return size;
}

SurfaceGrid::SurfaceGrid(const core::TriangleMesh& mesh, double cell, double band, int margin)
    : cell_(cell), band_(band / cell), size_(Size(mesh, cell, band, margin)) {
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh);
  // A fractional offset keeps axis-aligned faces off the nodes.
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = (size_[axis] - 1) * cell - bounds.sizes()[axis];
    origin_[axis] = bounds.min()[axis] - 0.5 * slack + cell * (0.0371 + 0.0113 * axis);
  }
  stride_ = {1, static_cast<std::size_t>(size_[0]),
             static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1])};
  const std::size_t nodes = stride_[2] * size_[2];
  distance_.assign(nodes, kFar);
  nearest_.assign(nodes, -1);
  crossed_.assign(nodes, 0);
  Subdivide(mesh);
  const int slabs = (size_[2] + kGridSlab - 1) / kGridSlab;
  std::vector<std::vector<int>> in_slab(slabs);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const double low = std::min({piece.a.z(), piece.b.z(), piece.c.z()}) - band_ - 1.0;
    const double high = std::max({piece.a.z(), piece.b.z(), piece.c.z()}) + band_ + 1.0;
    const int first = std::clamp(static_cast<int>(std::floor(low / kGridSlab)), 0, slabs - 1);
    const int last = std::clamp(static_cast<int>(std::floor(high / kGridSlab)), 0, slabs - 1);
    for (int s = first; s <= last; ++s) in_slab[s].push_back(static_cast<int>(p));
  }
  core::ParallelFor(slabs, [&](int slab) {
    core::CheckCancelled();
    const int low_k = slab * kGridSlab;
    const int high_k = std::min(size_[2] - 1, low_k + kGridSlab - 1);
    for (const int p : in_slab[slab]) {
      EnterDistances(pieces_[p], p, low_k, high_k);
      EnterCrossings(pieces_[p], low_k, high_k);
    }
    // Convert squared distances in cells to distances.
    for (std::size_t node = low_k * stride_[2]; node < (high_k + 1) * stride_[2]; ++node) {
      if (distance_[node] < kFar) {
        distance_[node] = static_cast<float>(std::sqrt(distance_[node]) * cell_);
      }
    }
  });
}

void SurfaceGrid::Subdivide(const core::TriangleMesh& mesh) {
  std::vector<Piece> stack;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto to_cells = [&](int v) -> Vector3d { return (mesh.vertices[v] - origin_) / cell_; };
    stack.push_back({to_cells(t[0]), to_cells(t[1]), to_cells(t[2])});
    while (!stack.empty()) {
      Piece piece = stack.back();
      stack.pop_back();
      const double ab = (piece.a - piece.b).lpNorm<Eigen::Infinity>();
      const double bc = (piece.b - piece.c).lpNorm<Eigen::Infinity>();
      const double ca = (piece.c - piece.a).lpNorm<Eigen::Infinity>();
      const double longest = std::max({ab, bc, ca});
      if (longest <= kPieceCells) {
        pieces_.push_back(piece);
        continue;
      }
      if (bc == longest)
        piece = {piece.b, piece.c, piece.a};
      else if (ca == longest)
        piece = {piece.c, piece.a, piece.b};
      const Vector3d middle = 0.5 * (piece.a + piece.b);
      stack.push_back({middle, piece.b, piece.c});
      stack.push_back({piece.a, middle, piece.c});
    }
  }
}

void SurfaceGrid::EnterDistances(const Piece& piece, int index, int low_k, int high_k) {
  const Vector3d low = piece.a.cwiseMin(piece.b).cwiseMin(piece.c);
  const Vector3d high = piece.a.cwiseMax(piece.b).cwiseMax(piece.c);
  std::array<int, 3> from, to;
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = std::max(0, static_cast<int>(std::ceil(low[axis] - band_)));
    to[axis] = std::min(size_[axis] - 1, static_cast<int>(std::floor(high[axis] + band_)));
  }
  from[2] = std::max(from[2], low_k);
  to[2] = std::min(to[2], high_k);
  const LaneTriangle triangle(piece.a, piece.b, piece.c);
  for (int k = from[2]; k <= to[2]; ++k) {
    for (int j = from[1]; j <= to[1]; ++j) {
      // The range of the row within the band around the triangle's plane.
      const double in_row = triangle.normal.y() * j + triangle.normal.z() * k - triangle.offset;
      int first = from[0];
      int last = to[0];
      const double slope = triangle.normal.x();
      if (std::abs(slope) > 1e-3) {
        const double middle = -in_row / slope;
        const double reach = band_ / std::abs(slope);
        first = std::max(first, static_cast<int>(std::ceil(middle - reach)));
        last = std::min(last, static_cast<int>(std::floor(middle + reach)));
      } else if (std::abs(in_row) > band_ + 1e-3 * size_[0]) {
        continue;
      }
      const std::size_t row = stride_[1] * j + stride_[2] * k;
      for (int i = first; i <= last; i += kLanes) {
        std::array<float, kLanes> squared;
        triangle.SquaredDistances(i, j, k, &squared);
        const int lanes = std::min(kLanes, last - i + 1);
        for (int lane = 0; lane < lanes; ++lane) {
          float& best = distance_[row + i + lane];
          if (squared[lane] < best && squared[lane] <= band_ * band_) {
            best = squared[lane];
            nearest_[row + i + lane] = index;
          }
        }
      }
    }
  }
}

void SurfaceGrid::EnterCrossings(const Piece& piece, int low_k, int high_k) {
  const Vector3d normal = (piece.b - piece.a).cross(piece.c - piece.a);
  for (int axis = 0; axis < 3; ++axis) {
    // Skip a triangle seen edge-on: its neighbours and its own edges mark the crossings.
    if (std::abs(normal[axis]) > 1e-9 * normal.norm()) {
      EnterCrossingsAlong(axis, piece, normal, low_k, high_k);
    }
  }
}

void SurfaceGrid::EnterCrossingsAlong(int axis, const Piece& piece, const Vector3d& normal,
                                      int low_k, int high_k) {
  const Vector3d low = piece.a.cwiseMin(piece.b).cwiseMin(piece.c);
  const Vector3d high = piece.a.cwiseMax(piece.b).cwiseMax(piece.c);
  std::array<int, 3> from, to;
  for (int other = 0; other < 3; ++other) {
    from[other] = std::max(0, static_cast<int>(std::ceil(low[other] - kSlack)));
    to[other] = std::min(size_[other] - 1, static_cast<int>(std::floor(high[other] + kSlack)));
  }
  from[2] = std::max(from[2], low_k);
  to[2] = std::min(to[2], high_k);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const std::array<const Vector3d*, 3> corners = {&piece.a, &piece.b, &piece.c};
  const double sign = normal[axis] > 0.0 ? 1.0 : -1.0;
  for (int at_v = from[v]; at_v <= to[v]; ++at_v) {
    for (int at_u = from[u]; at_u <= to[u]; ++at_u) {
      bool within = true;
      for (int e = 0; e < 3 && within; ++e) {
        const Vector3d& p = *corners[e];
        const Vector3d& q = *corners[(e + 1) % 3];
        const double du = q[u] - p[u];
        const double dv = q[v] - p[v];
        const double area = sign * (du * (at_v - p[v]) - dv * (at_u - p[u]));
        within = area >= -kSlack * (std::abs(du) + std::abs(dv));
      }
      if (!within) continue;
      const double along =
          piece.a[axis] -
          (normal[u] * (at_u - piece.a[u]) + normal[v] * (at_v - piece.a[v])) / normal[axis];
      const int first = static_cast<int>(std::floor(along - kSlack));
      const int last = static_cast<int>(std::floor(along + kSlack));
      for (int at = std::max(first, 0); at <= std::min(last, size_[axis] - 1); ++at) {
        if (axis == 2 && (at < low_k || at > high_k)) continue;
        std::array<int, 3> node;
        node[axis] = at;
        node[u] = at_u;
        node[v] = at_v;
        crossed_[node[0] + stride_[1] * node[1] + stride_[2] * node[2]] |=
            static_cast<std::uint8_t>(1 << axis);
      }
    }
  }
}

Vector3d SurfaceGrid::Position(std::size_t node) const {
  return origin_ + cell_ * Vector3d(static_cast<double>(node % stride_[1]),
                                    static_cast<double>(node / stride_[1] % size_[1]),
                                    static_cast<double>(node / stride_[2]));
}

Vector3d SurfaceGrid::Nearest(std::size_t node) const {
  const Piece& piece = pieces_[nearest_[node]];
  const Vector3d p(static_cast<double>(node % stride_[1]),
                   static_cast<double>(node / stride_[1] % size_[1]),
                   static_cast<double>(node / stride_[2]));
  return origin_ + cell_ * ClosestPointOnTriangle(p, piece.a, piece.b, piece.c);
}

}  // namespace simwright::geometry
