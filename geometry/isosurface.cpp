#include "geometry/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "core/progress.h"

namespace simwright::geometry {
namespace {

constexpr double kEndClearance = 0.01;

// The polygons of one cube for one pattern of inside corners (corner c at x = c & 1, y = c & 2, z =
// c & 4): edge numbers, each polygon counter-clockwise seen from outside.
struct CubePolygons {
  int count = 0;
  std::array<int, 4> size{};
  std::array<std::array<int, 12>, 4> edges{};
};

// Returns the edge number: 4 * axis + the two other coordinates of its lower corner, in cyclic
// order.
int EdgeOf(int corner_a, int corner_b) {
  const int axis = (corner_a ^ corner_b) == 1 ? 0 : (corner_a ^ corner_b) == 2 ? 1 : 2;
  const int low = std::min(corner_a, corner_b);
  const int u = (low >> ((axis + 1) % 3)) & 1;
  const int v = (low >> ((axis + 2) % 3)) & 1;
  return 4 * axis + u + 2 * v;
}

std::array<int, 4> FaceCorners(int axis, int side) {
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  const int base = side << axis;
  if (side == 1) return {base, base + u, base + u + v, base + v};
  return {base, base + v, base + u + v, base + u};
}

CubePolygons BuildPolygons(int pattern) {
  std::array<int, 12> next;
  next.fill(-1);
  int cut_edges = 0;
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = FaceCorners(face / 2, face % 2);
    int enters = -1;
    int leaves = -1;
    for (int c = 0; c < 4; ++c) {
      const int from = corners[c];
      const int to = corners[(c + 1) % 4];
      const bool from_inside = (pattern >> from) & 1;
      const bool to_inside = (pattern >> to) & 1;
      if (!from_inside && to_inside) enters = EdgeOf(from, to);
      if (from_inside && !to_inside) leaves = EdgeOf(from, to);
      cut_edges += from_inside != to_inside;
    }
    if (cut_edges > 2) return {};  // alternating corners: eliminated by Sides
    cut_edges = 0;
    if (enters >= 0) next[enters] = leaves;
  }
  CubePolygons polygons;
  std::array<bool, 12> used{};
  for (int start = 0; start < 12; ++start) {
    if (next[start] < 0 || used[start]) continue;
    int size = 0;
    for (int edge = start; edge >= 0 && !used[edge]; edge = next[edge]) {
      used[edge] = true;
      polygons.edges[polygons.count][size++] = edge;
    }
    polygons.size[polygons.count++] = size;
  }
  return polygons;
}

const std::array<CubePolygons, 256>& PolygonTable() {
  static const std::array<CubePolygons, 256> table = [] {
    std::array<CubePolygons, 256> built;
    for (int pattern = 0; pattern < 256; ++pattern) built[pattern] = BuildPolygons(pattern);
    return built;
  }();
  return table;
}

// The side of each node after all faces with alternating corners were eliminated.
class Sides {
 public:
  Sides(const ScalarGrid& field, float level) : field_(field), level_(level) {
    stride_ = {1, static_cast<std::size_t>(field.nx),
               static_cast<std::size_t>(field.nx) * field.ny};
    inside_.assign(field.values.size(), 0);
    for (int k = 1; k + 1 < field.nz; ++k) {
      for (int j = 1; j + 1 < field.ny; ++j) {
        const std::size_t row = field.Index(0, j, k);
        for (int i = 1; i + 1 < field.nx; ++i) {
          inside_[row + i] = field.values[row + i] < level ? kInside : 0;
        }
      }
    }
    RemoveAlternatingFaces();
  }

  bool Inside(std::size_t node) const { return inside_[node] & kInside; }

  // Returns the field's value, or the level itself if the node's side was flipped.
  float Value(std::size_t node) const {
    const float value = field_.values[node];
    return (value < level_) == Inside(node) ? value : level_;
  }

 private:
  static constexpr std::uint8_t kInside = 1;
  static constexpr std::uint8_t kTurnedInside = 2;

  struct Face {
    std::size_t node;
    int axis;
  };

  bool Alternates(const Face& face) const {
    const std::size_t u = stride_[(face.axis + 1) % 3];
    const std::size_t v = stride_[(face.axis + 2) % 3];
    const bool a = Inside(face.node);
    return Inside(face.node + u + v) == a && Inside(face.node + u) != a &&
           Inside(face.node + v) != a;
  }

  bool OnBorder(std::size_t node) const {
    const int i = static_cast<int>(node % stride_[1]);
    const int j = static_cast<int>(node / stride_[1] % field_.ny);
    const int k = static_cast<int>(node / stride_[2]);
    return i == 0 || j == 0 || k == 0 || i + 1 == field_.nx || j + 1 == field_.ny ||
           k + 1 == field_.nz;
  }

  // Terminates: each node flips inside at most once, and flips to outside only shrink the inside.
  void FlipOneNode(const Face& face) {
    const std::size_t u = stride_[(face.axis + 1) % 3];
    const std::size_t v = stride_[(face.axis + 2) % 3];
    const std::array<std::size_t, 4> nodes = {face.node, face.node + u, face.node + v,
                                              face.node + u + v};
    std::size_t chosen = nodes[0];
    float best = INFINITY;
    bool found = false;
    for (const std::size_t node : nodes) {
      if (!Inside(node) && ((inside_[node] & kTurnedInside) || OnBorder(node))) continue;
      float gap = std::abs(field_.values[node] - level_);
      if (std::isnan(gap)) gap = INFINITY;
      if (!found || gap < best) {
        best = gap;
        chosen = node;
        found = true;
      }
    }
    if (Inside(chosen)) {
      inside_[chosen] = static_cast<std::uint8_t>(inside_[chosen] & ~kInside);
    } else {
      inside_[chosen] |= kInside | kTurnedInside;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t a = stride_[(axis + 1) % 3];
      const std::size_t b = stride_[(axis + 2) % 3];
      for (const std::size_t low : {chosen, chosen - a, chosen - b, chosen - a - b}) {
        pending_.push_back({low, axis});
      }
    }
  }

  void RemoveAlternatingFaces() {
    for (int k = 0; k + 1 < field_.nz; ++k) {
      core::CheckCancelled();
      for (int j = 0; j + 1 < field_.ny; ++j) {
        const std::size_t row = field_.Index(0, j, k);
        for (int i = 0; i + 1 < field_.nx; ++i) {
          const std::size_t node = row + i;
          const bool a = Inside(node);
          if (Inside(node + stride_[1] + stride_[2]) == a &&
              Inside(node + stride_[0] + stride_[2]) == a &&
              Inside(node + stride_[0] + stride_[1]) == a) {
            if (Inside(node + stride_[0]) == a && Inside(node + stride_[1]) == a) continue;
          }
          for (int axis = 0; axis < 3; ++axis) {
            if (Alternates({node, axis})) pending_.push_back({node, axis});
          }
        }
      }
    }
    // A flipped node is not on the border, so the faces around it are within the grid.
    while (!pending_.empty()) {
      const Face face = pending_.back();
      pending_.pop_back();
      if (Alternates(face)) FlipOneNode(face);
    }
  }

  const ScalarGrid& field_;
  const float level_;
  std::array<std::size_t, 3> stride_;
  std::vector<std::uint8_t> inside_;
  std::vector<Face> pending_;
};

class Extractor {
 public:
  Extractor(const ScalarGrid& field, float level)
      : field_(field), level_(level), sides_(field, level) {
    layer_ = static_cast<std::size_t>(field.nx) * field.ny;
    for (auto& slab : vertex_) slab.assign(3 * layer_, -1);
  }

  core::TriangleMesh Run() {
    for (int k = 0; k + 1 < field_.nz; ++k) {
      core::CheckCancelled();
      for (int j = 0; j + 1 < field_.ny; ++j) Row(j, k);
      std::swap(vertex_[0], vertex_[1]);
      std::fill(vertex_[1].begin(), vertex_[1].end(), -1);
    }
    return std::move(mesh_);
  }

 private:
  void Row(int j, int k) {
    const std::size_t nx = field_.nx;
    const std::array<std::size_t, 4> rows = {field_.Index(0, j, k), field_.Index(0, j + 1, k),
                                             field_.Index(0, j, k + 1),
                                             field_.Index(0, j + 1, k + 1)};
    int right = 0;
    for (int r = 0; r < 4; ++r) right |= static_cast<int>(sides_.Inside(rows[r])) << (2 * r);
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      const int left = right;
      right = 0;
      for (int r = 0; r < 4; ++r) {
        right |= static_cast<int>(sides_.Inside(rows[r] + i + 1)) << (2 * r);
      }
      const int pattern = left | (right << 1);
      if (pattern != 0 && pattern != 255) Cube(static_cast<int>(i), j, k, pattern);
    }
  }

  void Cube(int i, int j, int k, int pattern) {
    const CubePolygons& polygons = PolygonTable()[pattern];
    for (int p = 0; p < polygons.count; ++p) {
      const int size = polygons.size[p];
      std::array<int, 12> corner;
      for (int c = 0; c < size; ++c) corner[c] = Vertex(i, j, k, polygons.edges[p][c]);
      for (int c = 1; c + 1 < size; ++c) {
        mesh_.triangles.emplace_back(corner[0], corner[c], corner[c + 1]);
      }
    }
  }

  int Vertex(int i, int j, int k, int edge) {
    const int axis = edge / 4;
    std::array<int, 3> at = {i, j, k};
    at[(axis + 1) % 3] += edge & 1;
    at[(axis + 2) % 3] += (edge >> 1) & 1;
    const std::size_t in_layer = at[0] + static_cast<std::size_t>(field_.nx) * at[1];
    int& vertex = vertex_[at[2] - k][3 * in_layer + axis];
    if (vertex >= 0) return vertex;
    const std::size_t low = field_.Index(at[0], at[1], at[2]);
    const std::size_t step = axis == 0 ? 1 : axis == 1 ? field_.nx : layer_;
    const double a = static_cast<double>(sides_.Value(low)) - level_;
    const double b = static_cast<double>(sides_.Value(low + step)) - level_;
    double t = a / (a - b);
    if (!std::isfinite(t)) t = std::isinf(a) && !std::isinf(b) ? 1.0 : 0.5;
    Eigen::Vector3d position(at[0], at[1], at[2]);
    position[axis] += std::clamp(t, kEndClearance, 1.0 - kEndClearance);
    vertex = static_cast<int>(mesh_.vertices.size());
    mesh_.vertices.push_back(field_.origin + field_.cell * position);
    return vertex;
  }

  const ScalarGrid& field_;
  const float level_;
  const Sides sides_;
  std::size_t layer_;
  // The vertices on the edges that start in the lower and in the upper layer of the current cubes.
  std::array<std::vector<int>, 2> vertex_;
  core::TriangleMesh mesh_;
};

}  // namespace

core::TriangleMesh ExtractIsosurface(const ScalarGrid& field, float level) {
  if (field.nx < 2 || field.ny < 2 || field.nz < 2 || !(field.cell > 0.0) ||
      !std::isfinite(field.cell) || !field.origin.allFinite() || std::isnan(level)) {
    throw core::Error("a grid needs two nodes along each axis and a finite, positive cell",
                      "isosurface");
  }
  if (field.values.size() != static_cast<std::size_t>(field.nx) * field.ny * field.nz) {
    throw core::Error("the number of values is not nx * ny * nz", "isosurface");
  }
  return Extractor(field, level).Run();
}

}  // namespace simwright::geometry
