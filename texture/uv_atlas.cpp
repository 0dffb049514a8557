#include "texture/uv_atlas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/error.h"

namespace simwright::texture {
namespace {

// The u and v axes of the projection planes for the three axes, right-handed with the normal.
constexpr int kUAxis[3] = {1, 2, 0}, kVAxis[3] = {2, 0, 1};

struct Chart {
  std::vector<int> triangles;
  Eigen::Vector2d low{0, 0}, high{0, 0};  // metres, in the projection plane
  int x = 0, y = 0;                       // position in the atlas, pixels
};

int DirectionOf(const Eigen::Vector3d& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
}

class Unwrapper {
 public:
  Unwrapper(const core::TriangleMesh& mesh, const AtlasOptions& options)
      : mesh_(mesh), options_(options) {}

  std::vector<Eigen::Vector2f> Unwrap() {
    Classify();
    std::vector<int> rest(mesh_.triangles.size());
    std::iota(rest.begin(), rest.end(), 0);
    // Each pass makes charts of the remaining triangles and removes overlapping ones; the last pass
    // makes a chart of every remaining triangle.
    constexpr int kPasses = 12;
    for (int pass = 0; pass < kPasses && !rest.empty(); ++pass) rest = MakeCharts(rest);
    for (const int t : rest) AddChart({t});
    Pack();
    return CornerUvs();
  }

 private:
  Eigen::Vector2d Flat(int triangle, int corner) const {
    const int direction = direction_[static_cast<size_t>(triangle)];
    const Eigen::Vector3d& p = mesh_.vertices[mesh_.triangles[triangle][corner]];
    const int axis = direction / 2;
    // Mirrored for negative directions, so that no chart shows its texture reversed.
    return {direction % 2 ? -p[kUAxis[axis]] : p[kUAxis[axis]], p[kVAxis[axis]]};
  }

  void Classify() {
    direction_.resize(mesh_.triangles.size());
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
      direction_[t] = DirectionOf(core::TriangleAreaVector(mesh_, static_cast<int>(t)));
    }
  }

  void AddChart(std::vector<int> triangles) {
    Chart chart;
    chart.triangles = std::move(triangles);
    chart.low = chart.high = Flat(chart.triangles[0], 0);
    for (const int t : chart.triangles) {
      for (int k = 0; k < 3; ++k) {
        chart.low = chart.low.cwiseMin(Flat(t, k));
        chart.high = chart.high.cwiseMax(Flat(t, k));
      }
    }
    charts_.push_back(std::move(chart));
  }

  std::vector<std::vector<int>> ConnectedPieces(const std::vector<int>& triangles) const;
  std::vector<int> MakeCharts(const std::vector<int>& triangles);
  std::vector<int> TakeOverlaps(std::vector<int>* piece) const;
  bool PackAt(double pixels_per_metre);
  void Pack();
  std::vector<Eigen::Vector2f> CornerUvs() const;

  const core::TriangleMesh& mesh_;
  const AtlasOptions& options_;
  std::vector<int> direction_;
  std::vector<Chart> charts_;
  double density_ = 0.0;  // pixels per metre
};

// Returns the connected pieces within one direction, each in ascending order.
std::vector<std::vector<int>> Unwrapper::ConnectedPieces(const std::vector<int>& triangles) const {
  std::vector<int> root(mesh_.triangles.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  std::map<std::tuple<int, int, int>, int> owner_of_edge;
  for (const int t : triangles) {
    const Eigen::Vector3i& corners = mesh_.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(corners[k], corners[(k + 1) % 3]);
      const auto [entry, fresh] = owner_of_edge.try_emplace({direction_[t], a, b}, t);
      if (!fresh) root[find(t)] = find(entry->second);
    }
  }
  std::map<int, std::vector<int>> pieces;
  for (const int t : triangles) pieces[find(t)].push_back(t);
  std::vector<std::vector<int>> result;
  for (auto& [key, piece] : pieces) result.push_back(std::move(piece));
  return result;
}

std::vector<int> Unwrapper::MakeCharts(const std::vector<int>& triangles) {
  std::vector<int> left_over;
  for (std::vector<int>& piece : ConnectedPieces(triangles)) {
    const std::vector<int> overlapping = TakeOverlaps(&piece);
    left_over.insert(left_over.end(), overlapping.begin(), overlapping.end());
    if (!piece.empty()) AddChart(std::move(piece));
  }
  std::sort(left_over.begin(), left_over.end());
  return left_over;
}

// Removes from `piece`, and returns, triangles that cover a grid cell which another one covers. The
// grid has about four cells per triangle; a triangle that covers no cell centre overlaps by less
// than a cell and stays.
std::vector<int> Unwrapper::TakeOverlaps(std::vector<int>* piece) const {
  if (piece->size() < 3) return {};
  Eigen::Vector2d low = Flat((*piece)[0], 0), high = low;
  for (const int t : *piece) {
    for (int k = 0; k < 3; ++k) {
      low = low.cwiseMin(Flat(t, k));
      high = high.cwiseMax(Flat(t, k));
    }
  }
  const double longest = std::max((high - low).maxCoeff(), 1e-30);
  const int cells = std::clamp(static_cast<int>(4.0 * std::sqrt(piece->size())), 16, 1024);
  const double cell = longest / cells;
  std::vector<int> owner(static_cast<size_t>(cells + 1) * (cells + 1), -1);
  std::vector<int> kept, taken, touched;
  for (const int t : *piece) {
    const Eigen::Vector2d a = (Flat(t, 0) - low) / cell, b = (Flat(t, 1) - low) / cell,
                          c = (Flat(t, 2) - low) / cell;
    const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    bool overlaps = area <= 0.0;  // folded over in the projection
    touched.clear();
    const Eigen::Vector2d from = a.cwiseMin(b).cwiseMin(c), to = a.cwiseMax(b).cwiseMax(c);
    for (int y = static_cast<int>(from.y()); y <= to.y() && !overlaps; ++y) {
      for (int x = static_cast<int>(from.x()); x <= to.x() && !overlaps; ++x) {
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        const auto side = [&](const Eigen::Vector2d& m, const Eigen::Vector2d& n) {
          return (n - m).x() * (p - m).y() - (n - m).y() * (p - m).x();
        };
        if (side(a, b) < 0.0 || side(b, c) < 0.0 || side(c, a) < 0.0) continue;
        const int at = y * (cells + 1) + x;
        overlaps = owner[static_cast<size_t>(at)] >= 0;
        touched.push_back(at);
      }
    }
    if (overlaps) {
      taken.push_back(t);
      continue;
    }
    for (const int at : touched) owner[static_cast<size_t>(at)] = t;
    kept.push_back(t);
  }
  // A piece that folds over as a whole would never shrink: keep its first triangle.
  if (kept.empty()) {
    kept.push_back(taken.front());
    taken.erase(taken.begin());
  }
  *piece = std::move(kept);
  return taken;
}

bool Unwrapper::PackAt(double pixels_per_metre) {
  std::vector<int> order(charts_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto extent = [&](int chart, int axis) {
    const Chart& c = charts_[static_cast<size_t>(chart)];
    return static_cast<int>(std::ceil((c.high - c.low)[axis] * pixels_per_metre)) + 1 +
           2 * options_.padding;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return extent(a, 1) > extent(b, 1); });
  int x = 0, y = 0, shelf = 0;
  for (const int chart : order) {
    const int width = extent(chart, 0), height = extent(chart, 1);
    if (width > options_.size) return false;
    if (x + width > options_.size) {
      x = 0;
      y += shelf;
      shelf = 0;
    }
    shelf = std::max(shelf, height);
    if (y + shelf > options_.size) return false;
    charts_[static_cast<size_t>(chart)].x = x + options_.padding;
    charts_[static_cast<size_t>(chart)].y = y + options_.padding;
    x += width;
  }
  return true;
}

void Unwrapper::Pack() {
  double area = 0.0;
  for (const Chart& chart : charts_) {
    area += std::max(1e-30, (chart.high - chart.low).prod());
  }
  density_ = options_.size / std::sqrt(area);
  for (int attempt = 0; attempt < 400; ++attempt, density_ *= 0.97) {
    if (PackAt(density_)) return;
  }
  throw core::Error("the mesh has too many separate pieces for a texture of " +
                        std::to_string(options_.size) + " pixels",
                    "", "simplify it or use a larger texture");
}

std::vector<Eigen::Vector2f> Unwrapper::CornerUvs() const {
  std::vector<Eigen::Vector2f> uvs(3 * mesh_.triangles.size());
  for (const Chart& chart : charts_) {
    for (const int t : chart.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d pixel =
            (Flat(t, k) - chart.low) * density_ + Eigen::Vector2d(chart.x + 0.5, chart.y + 0.5);
        uvs[3 * static_cast<size_t>(t) + static_cast<size_t>(k)] =
            (pixel / options_.size).cast<float>();
      }
    }
  }
  return uvs;
}

}  // namespace

std::vector<Eigen::Vector2f> UnwrapToAtlas(const core::TriangleMesh& mesh,
                                           const AtlasOptions& options) {
  core::RequireValid(mesh, "texture atlas");
  if (mesh.triangles.empty() || options.size < 16 || options.padding < 0) {
    throw core::Error("an atlas needs a mesh and at least 16 pixels");
  }
  return Unwrapper(mesh, options).Unwrap();
}

}  // namespace simwright::texture
