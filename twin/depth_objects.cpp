#include "twin/depth_objects.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "twin/detection_mask.h"
#include "twin/plane_hull.h"

namespace simwright::twin {
namespace {

constexpr double kSeedHeight = 0.008, kGrownHeight = 0.003;  // m above the plane
constexpr double kSeedDeviations = 3.0, kGrownDeviations = 2.0;
constexpr double kTallest = 0.6;        // m: what is higher is no object on the table
constexpr double kInsideTable = 0.004;  // m from the table's edge: beyond may be a wall
constexpr double kSamePiece = 0.012, kSamePieceGrowth = 0.01;  // m of depth, and per m
constexpr double kSmallShare = 0.25;       // of its neighbour's pixels: a piece may be part of it
constexpr double kPartDistance = 0.06;     // m of depth between an object's handle and its body
constexpr double kLeastPieceShare = 3e-4;  // of the picture's
constexpr int kFewestPixels = 24;
constexpr double kLargePlanePiece = 0.03;  // of the plane's pixels: smaller ones are accidents

using Index = std::size_t;

// Pixels in pieces, the pixels of each in the order in which they were reached.
struct Pieces {
  std::vector<int> of_pixel;  // -1: none
  std::vector<std::vector<Index>> pixels;
};

// Labels the pixels for which `takes` holds; neighbours are of one piece if `joined` holds.
Pieces LabelPieces(int width, int height, const std::function<bool(Index)>& takes,
                   const std::function<bool(Index, Index)>& joined) {
  Pieces pieces;
  pieces.of_pixel.assign(static_cast<Index>(width) * height, -1);
  for (Index start = 0; start < pieces.of_pixel.size(); ++start) {
    if (pieces.of_pixel[start] >= 0 || !takes(start)) continue;
    const int piece = static_cast<int>(pieces.pixels.size());
    std::vector<Index> reached{start};
    pieces.of_pixel[start] = piece;
    for (Index next = 0; next < reached.size(); ++next) {
      const Index at = reached[next];
      const int x = static_cast<int>(at % width), y = static_cast<int>(at / width);
      const std::pair<int, int> steps[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
      for (const auto& [dx, dy] : steps) {
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
        const Index to = static_cast<Index>(ny) * width + nx;
        if (pieces.of_pixel[to] >= 0 || !takes(to) || !joined(at, to)) continue;
        pieces.of_pixel[to] = piece;
        reached.push_back(to);
      }
    }
    pieces.pixels.push_back(std::move(reached));
  }
  return pieces;
}

// The pixels of a depth image over its plane.
class DepthRelief {
 public:
  DepthRelief(const core::FloatImage& depth, const DepthPlane& plane)
      : depth_(depth),
        seed_(std::max(kSeedHeight, kSeedDeviations * plane.error)),
        grown_(std::min(seed_, std::max(kGrownHeight, kGrownDeviations * plane.error))) {
    const core::Camera camera = plane.camera.At(depth.width, depth.height);
    height_.assign(depth.values.size(), -1.0f);
    ground_.resize(depth.values.size());
    for (int y = 0; y < depth.height; ++y) {
      for (int x = 0; x < depth.width; ++x) {
        const Index at = static_cast<Index>(y) * depth.width + x;
        const double z = depth.values[at];
        if (!(z > 0.0)) continue;
        const Eigen::Vector3d point =
            camera.position() + z * camera.Ray(Eigen::Vector2d(x + 0.5, y + 0.5));
        height_[at] = static_cast<float>(point.z());
        ground_[at] = point.head<2>().cast<float>();
      }
    }
    MarkTable();
  }

  bool IsObject(Index at) const { return on_table_[at] && height_[at] > grown_; }
  bool IsSeed(Index at) const { return height_[at] > seed_; }
  bool Joined(Index a, Index b) const {
    return DepthStep(a, b) < kSamePiece + kSamePieceGrowth * depth_.values[a];
  }
  double DepthStep(Index a, Index b) const { return std::abs(depth_.values[a] - depth_.values[b]); }

 private:
  // Marks the pixels over the hull of the plane's large pieces.
  void MarkTable() {
    const auto flat = [&](Index at) {
      return depth_.values[at] > 0.0f && std::abs(height_[at]) <= grown_;
    };
    const Pieces pieces =
        LabelPieces(depth_.width, depth_.height, flat, [](Index, Index) { return true; });
    Index all = 0;
    for (const std::vector<Index>& pixels : pieces.pixels) all += pixels.size();
    std::vector<Eigen::Vector2d> points;
    for (const std::vector<Index>& pixels : pieces.pixels) {
      if (static_cast<double>(pixels.size()) < kLargePlanePiece * static_cast<double>(all)) {
        continue;
      }
      for (const Index at : pixels) points.push_back(ground_[at].cast<double>());
    }
    const PlaneHull hull(std::move(points));
    on_table_.assign(depth_.values.size(), false);
    for (Index at = 0; at < on_table_.size(); ++at) {
      if (height_[at] <= grown_ || height_[at] > kTallest) continue;
      on_table_[at] = hull.DepthInside(ground_[at].cast<double>()) > kInsideTable;
    }
  }

  const core::FloatImage& depth_;
  double seed_, grown_;
  std::vector<float> height_;            // m; -1 where nothing is measured
  std::vector<Eigen::Vector2f> ground_;  // m, below the point
  std::vector<bool> on_table_;
};

// Gives small pieces to the neighbour from which only a short step of depth divides them: the
// handle of a mug before its body, the far wall of a bowl. Returns the piece that each became.
std::vector<int> MergedPieces(const Pieces& pieces, const DepthRelief& relief, int width) {
  std::map<std::pair<int, int>, double> steps;  // the least between two pieces
  for (Index at = 0; at < pieces.of_pixel.size(); ++at) {
    for (const Index to : {at % width + 1 < static_cast<Index>(width) ? at + 1 : at, at + width}) {
      if (to >= pieces.of_pixel.size()) continue;
      const int a = pieces.of_pixel[at], b = pieces.of_pixel[to];
      if (a < 0 || b < 0 || a == b) continue;
      const auto key = std::minmax(a, b);
      const double step = relief.DepthStep(at, to);
      const auto [found, is_new] = steps.emplace(key, step);
      if (!is_new) found->second = std::min(found->second, step);
    }
  }
  std::vector<int> merged(pieces.pixels.size());
  for (size_t k = 0; k < merged.size(); ++k) merged[k] = static_cast<int>(k);
  const auto count = [&](int piece) { return pieces.pixels[static_cast<size_t>(piece)].size(); };
  for (const auto& [pair, step] : steps) {
    if (step > kPartDistance) continue;
    const auto [small, large] =
        count(pair.first) < count(pair.second) ? pair : std::pair(pair.second, pair.first);
    if (static_cast<double>(count(small)) > kSmallShare * static_cast<double>(count(large))) {
      continue;
    }
    int& of = merged[static_cast<size_t>(small)];
    if (of == small || count(large) > count(of)) of = large;
  }
  // A piece leads to a larger one each time, so that the chains end.
  for (int& of : merged) {
    while (merged[static_cast<size_t>(of)] != of) of = merged[static_cast<size_t>(of)];
  }
  return merged;
}

// Returns the mask of pixels, with the holes in it where nothing was measured.
Detection DetectionOf(const std::vector<Index>& pixels, const core::FloatImage& depth) {
  core::Image mask(depth.width, depth.height, 1);
  for (const Index at : pixels) mask.pixels[at] = 255;
  Detection detection = DetectionOfMask(std::move(mask));
  const auto unmeasured = [&](Index at) {
    const Eigen::Vector2d middle(static_cast<double>(at % depth.width) + 0.5,
                                 static_cast<double>(at / depth.width) + 0.5);
    return detection.alpha.pixels[at] == 0 && depth.values[at] == 0.0f &&
           detection.box.contains(middle);
  };
  const Pieces holes =
      LabelPieces(depth.width, depth.height, unmeasured, [](Index, Index) { return true; });
  for (const std::vector<Index>& hole : holes.pixels) {
    const bool enclosed = std::all_of(hole.begin(), hole.end(), [&](Index at) {
      const Index width = static_cast<Index>(depth.width);
      const Index x = at % width;
      if (x == 0 || x + 1 == width || at < width || at + width >= depth.values.size()) return false;
      for (const Index to : {at - 1, at + 1, at - width, at + width}) {
        if (detection.alpha.pixels[to] == 0 && !unmeasured(to)) return false;
      }
      return true;
    });
    if (!enclosed) continue;
    for (const Index at : hole) detection.alpha.pixels[at] = 255;
  }
  return detection;
}

}  // namespace

std::vector<Detection> ObjectsAbovePlane(const core::FloatImage& depth, const DepthPlane& plane) {
  const DepthRelief relief(depth, plane);
  const Pieces pieces = LabelPieces(
      depth.width, depth.height, [&](Index at) { return relief.IsObject(at); },
      [&](Index a, Index b) { return relief.Joined(a, b); });
  const std::vector<int> merged = MergedPieces(pieces, relief, depth.width);
  std::map<int, std::vector<Index>> objects;
  for (size_t k = 0; k < pieces.pixels.size(); ++k) {
    std::vector<Index>& object = objects[merged[k]];
    object.insert(object.end(), pieces.pixels[k].begin(), pieces.pixels[k].end());
  }
  const double least =
      std::max<double>(kFewestPixels, kLeastPieceShare * static_cast<double>(depth.values.size()));
  std::vector<std::vector<Index>> kept;
  for (auto& [piece, pixels] : objects) {
    const auto seeds =
        std::count_if(pixels.begin(), pixels.end(), [&](Index at) { return relief.IsSeed(at); });
    if (static_cast<double>(seeds) >= least) kept.push_back(std::move(pixels));
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<Detection> detections;
  for (const std::vector<Index>& pixels : kept) detections.push_back(DetectionOf(pixels, depth));
  return detections;
}

}  // namespace simwright::twin
