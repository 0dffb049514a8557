#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include <Eigen/Eigenvalues>

#include "texture/materials/material_bake.h"
#include "texture/materials/noise.h"

namespace simwright::texture {
namespace {

constexpr double kElongated = 1.25;  // of the extents: then the grain follows the longer one
constexpr double kAlongAxis = 0.94;  // cosine: the grain snaps to an axis of the frame
constexpr double kRoundness = 0.05;  // relative spread of the outline's radius

int Root(std::vector<int>* parent, int v) {
  while ((*parent)[v] != v) v = (*parent)[v] = (*parent)[(*parent)[v]];
  return v;
}

// Returns the number of the connected piece of each triangle.
std::vector<int> PiecesOf(const core::TriangleMesh& mesh, const std::vector<int>& labels,
                          int* count) {
  const double cell = 1e-6 * std::max(1e-9, core::Bounds(mesh).diagonal().norm());
  std::map<std::tuple<long, long, long, int>, int> places;  // to the first triangle there
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = mesh.vertices[mesh.triangles[t][k]];
      const auto key = std::make_tuple(std::lround(p.x() / cell), std::lround(p.y() / cell),
                                       std::lround(p.z() / cell), labels[t]);
      const int first = places.try_emplace(key, static_cast<int>(t)).first->second;
      parent[Root(&parent, static_cast<int>(t))] = Root(&parent, first);
    }
  }
  std::map<int, int> numbers;
  std::vector<int> pieces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int root = Root(&parent, static_cast<int>(t));
    pieces.push_back(numbers.try_emplace(root, static_cast<int>(numbers.size())).first->second);
  }
  *count = static_cast<int>(numbers.size());
  return pieces;
}

Eigen::Vector3f GrainOf(const std::vector<Eigen::Vector3d>& points,
                        const Eigen::AlignedBox3d& box) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  Eigen::Vector3d axis = solver.eigenvectors().col(2);
  int longest = 0;
  box.sizes().maxCoeff(&longest);
  if (values[2] < kElongated * values[1]) axis = Eigen::Vector3d::Unit(longest);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > kAlongAxis) axis = Eigen::Vector3d::Unit(k);
  }
  return axis.cast<float>();
}

// Returns true if the piece is one of revolution about the vertical through its middle: its
// outermost points lie on a circle at all angles. Handles and spouts may stick out.
bool IsRound(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector2d& center) {
  constexpr int kBins = 24;
  std::vector<double> radius(kBins, 0.0);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d d = p.head<2>() - center;
    const double turn = std::atan2(d.y(), d.x()) / (2.0 * M_PI) + 0.5;
    double& largest = radius[static_cast<std::size_t>(turn * kBins) % kBins];
    largest = std::max(largest, d.norm());
  }
  std::sort(radius.begin(), radius.end());
  // A coarse circle has corners in some bins only.
  const double low = radius[kBins / 6], high = radius[5 * kBins / 6];
  return low > 0.0 && high - low < kRoundness * high;
}

// Returns the middle of the circle through the outline: the middle of the box, or of its narrower
// side where something sticks out of the wider one.
Eigen::Vector2d RoundCenter(const std::vector<Eigen::Vector3d>& points,
                            const Eigen::AlignedBox3d& box) {
  std::vector<double> xs, ys;
  for (const Eigen::Vector3d& p : points) {
    xs.push_back(p.x());
    ys.push_back(p.y());
  }
  Eigen::Vector2d center = box.center().head<2>();
  const Eigen::Vector3d size = box.sizes();
  const int wide = size.x() > size.y() ? 0 : 1;
  const double radius = 0.5 * size[1 - wide];
  if (size[wide] < 1.02 * size[1 - wide]) return center;
  // Either end may carry the handle: the one whose opposite end has more points in its arc.
  std::vector<double>& along = wide == 0 ? xs : ys;
  const double from_low = box.min()[wide] + radius, from_high = box.max()[wide] - radius;
  int low = 0, high = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double other = wide == 0 ? ys[i] : xs[i];
    const double off = other - center[1 - wide];
    low += std::abs(std::hypot(along[i] - from_low, off) - radius) < 0.04 * radius;
    high += std::abs(std::hypot(along[i] - from_high, off) - radius) < 0.04 * radius;
  }
  center[wide] = low >= high ? from_low : from_high;
  return center;
}

PartFrame FrameOfPoints(const std::vector<Eigen::Vector3d>& points, std::uint32_t seed) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  PartFrame frame;
  frame.seed = seed;
  if (points.empty()) return frame;
  frame.grain = GrainOf(points, box);
  const Eigen::Vector2d center = RoundCenter(points, box);
  frame.round = IsRound(points, center);
  if (frame.round) {
    // The box of the body alone, so that its middle is the axis.
    const Eigen::Vector3d size = box.sizes();
    const double half = 0.5 * std::min(size.x(), size.y());
    box.min().head<2>() = center - Eigen::Vector2d::Constant(half);
    box.max().head<2>() = center + Eigen::Vector2d::Constant(half);
  }
  frame.box = box.cast<float>();
  return frame;
}

}  // namespace

std::vector<PartFrame> FramesOfLabels(const core::TriangleMesh& mesh,
                                      const std::vector<int>& labels, int count) {
  std::vector<std::vector<Eigen::Vector3d>> points(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      points[static_cast<std::size_t>(labels[t])].push_back(mesh.vertices[mesh.triangles[t][k]]);
    }
  }
  std::vector<PartFrame> frames;
  for (std::size_t label = 0; label < points.size(); ++label) {
    frames.push_back(FrameOfPoints(points[label], CellHash(static_cast<int>(label), 0, 0, 77u)));
  }
  return frames;
}

PieceFrames FramesOfPieces(const core::TriangleMesh& mesh, const std::vector<int>& labels) {
  PieceFrames result;
  int count = 0;
  result.triangle_frame = PiecesOf(mesh, labels, &count);
  result.frames = FramesOfLabels(mesh, result.triangle_frame, count);
  return result;
}

}  // namespace simwright::texture
