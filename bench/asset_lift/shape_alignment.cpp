#include "shape_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/surface_distance.h"

namespace simwright::bench {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kRays = 15000;        // two hits each: about 20,000 points for the scores
constexpr int kTreePoints = 8000;   // in the tree for the alignment
constexpr int kSearchPoints = 300;  // to score a candidate rotation
constexpr int kFitPoints = 2000;    // for iterated closest points
constexpr int kRefined = 8;
constexpr int kIterations = 40;

double UniformScale(const Eigen::Affine3d& map) {
  return std::cbrt(map.linear().determinant());
}

Eigen::Affine3d ToUnitBox(const Eigen::AlignedBox3d& box) {
  return Eigen::Scaling(2.0 / box.sizes().maxCoeff()) * Eigen::Translation3d(-box.center());
}

size_t Used(const std::vector<Eigen::Vector3d>& points, int count) {
  return std::min(points.size(), static_cast<size_t>(count));
}

// Returns the map from the box of the rotated points to the normalized frame.
Eigen::Affine3d Turned(const ComparableShape& shape, const Eigen::Matrix3d& rotation) {
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < Used(shape.points(), kFitPoints); ++i) {
    box.extend(rotation * shape.points()[i]);
  }
  return ToUnitBox(box) * Eigen::Affine3d(rotation);
}

// Returns the mean of both directions' mean distances between points.
double PointChamfer(const ComparableShape& truth, const ComparableShape& other,
                    const Eigen::Affine3d& truth_from_other, int count) {
  const Eigen::Affine3d other_from_truth = truth_from_other.inverse();
  const size_t truths = Used(truth.points(), count), others = Used(other.points(), count);
  double there = 0.0, back = 0.0;
  for (size_t i = 0; i < others; ++i) {
    const Eigen::Vector3d p = truth_from_other * other.points()[i];
    there += (truth.tree().Nearest(p) - p).norm();
  }
  for (size_t i = 0; i < truths; ++i) {
    const Eigen::Vector3d p = other_from_truth * truth.points()[i];
    back += (other.tree().Nearest(p) - p).norm();
  }
  return 0.5 * (there / static_cast<double>(others) +
                UniformScale(truth_from_other) * back / static_cast<double>(truths));
}

struct Pairs {
  Eigen::Matrix3Xd other, truth;
};

// Finds closest points in both directions: with one alone, a smaller copy inside fits perfectly.
// Returns the Chamfer distance at the map for which they were found.
double FindPairs(const ComparableShape& truth, const ComparableShape& other,
                 const Eigen::Affine3d& truth_from_other, Pairs* pairs) {
  const Eigen::Affine3d other_from_truth = truth_from_other.inverse();
  const size_t others = Used(other.points(), kFitPoints);
  const size_t truths = Used(truth.points(), kFitPoints);
  pairs->other.resize(3, static_cast<long>(others + truths));
  pairs->truth.resize(3, static_cast<long>(others + truths));
  double there = 0.0, back = 0.0;
  for (size_t i = 0; i < others; ++i) {
    const Eigen::Vector3d p = truth_from_other * other.points()[i];
    const Eigen::Vector3d& nearest = truth.tree().Nearest(p);
    pairs->other.col(static_cast<long>(i)) = other.points()[i];
    pairs->truth.col(static_cast<long>(i)) = nearest;
    there += (nearest - p).norm();
  }
  for (size_t i = 0; i < truths; ++i) {
    const Eigen::Vector3d p = other_from_truth * truth.points()[i];
    const Eigen::Vector3d& nearest = other.tree().Nearest(p);
    pairs->truth.col(static_cast<long>(others + i)) = truth.points()[i];
    pairs->other.col(static_cast<long>(others + i)) = nearest;
    back += (nearest - p).norm();
  }
  return 0.5 * (there / static_cast<double>(others) +
                UniformScale(truth_from_other) * back / static_cast<double>(truths));
}

Eigen::Affine3d FitSimilarity(const Pairs& pairs) {
  const Eigen::Vector3d from = pairs.other.rowwise().mean(), to = pairs.truth.rowwise().mean();
  const Eigen::Matrix3d rotation =
      Eigen::umeyama(pairs.other, pairs.truth, false).topLeftCorner<3, 3>();
  const double scale =
      (pairs.truth.colwise() - to).norm() / std::max((pairs.other.colwise() - from).norm(), 1e-12);
  return Eigen::Translation3d(to) * Eigen::Scaling(scale) * Eigen::Affine3d(rotation) *
         Eigen::Translation3d(-from);
}

struct Candidate {
  Eigen::Affine3d truth_from_other = Eigen::Affine3d::Identity();
  double chamfer = std::numeric_limits<double>::infinity();
};

Candidate Refined(const ComparableShape& truth, const ComparableShape& other,
                  const Eigen::Affine3d& start) {
  Candidate best;
  Eigen::Affine3d now = start;
  Pairs pairs;
  for (int i = 0; i < kIterations; ++i) {
    const double chamfer = FindPairs(truth, other, now, &pairs);
    if (chamfer < best.chamfer) best = {now, chamfer};
    const Eigen::Affine3d next = FitSimilarity(pairs);
    // Far below the resolution of points of this spacing.
    if ((next.matrix() - now.matrix()).norm() < 1e-4) break;
    now = next;
  }
  return best;
}

std::vector<Eigen::Matrix3d> SearchRotations() {
  std::vector<Eigen::Matrix3d> tilts = {Eigen::Matrix3d::Identity()};
  for (const double angle : {12.0, 24.0}) {
    for (int side = 0; side < 6; ++side) {
      const double a = side * 60.0 * kDegree;
      const Eigen::Vector3d axis(std::cos(a), std::sin(a), 0.0);
      tilts.push_back(Eigen::AngleAxisd(angle * kDegree, axis).toRotationMatrix());
    }
  }
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Matrix3d& tilt : tilts) {
    for (int turn = 0; turn < 36; ++turn) {
      rotations.push_back(tilt *
                          Eigen::AngleAxisd(turn * 10.0 * kDegree, Eigen::Vector3d::UnitZ()));
    }
  }
  return rotations;
}

double TurningDefectAbout(const ComparableShape& shape, const Eigen::Vector3d& middle) {
  double worst = 0.0;
  for (const double angle : {37.0, 73.0, 127.0}) {
    const Eigen::AngleAxisd turn(angle * kDegree, Eigen::Vector3d::UnitZ());
    double sum = 0.0;
    const size_t count = Used(shape.points(), kFitPoints);
    for (size_t i = 0; i < count; ++i) {
      sum += shape.surface().Closest(middle + turn * (shape.points()[i] - middle)).distance;
    }
    worst = std::max(worst, sum / static_cast<double>(count));
  }
  return worst;
}

}  // namespace

PointTree::PointTree(std::vector<Eigen::Vector3d> points)
    : points_(std::move(points)), axes_(points_.size()) {
  Split(0, points_.size());
}

void PointTree::Split(size_t first, size_t last) {
  if (last - first < 2) return;
  Eigen::AlignedBox3d box;
  for (size_t i = first; i < last; ++i) box.extend(points_[i]);
  long axis = 0;
  box.sizes().maxCoeff(&axis);
  const size_t middle = first + (last - first) / 2;
  const auto at = [&](size_t i) { return points_.begin() + static_cast<long>(i); };
  std::nth_element(at(first), at(middle), at(last),
                   [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
  axes_[middle] = static_cast<std::uint8_t>(axis);
  Split(first, middle);
  Split(middle + 1, last);
}

void PointTree::Search(size_t first, size_t last, const Eigen::Vector3d& p, double* squared,
                       size_t* best) const {
  while (first < last) {
    const size_t middle = first + (last - first) / 2;
    const double here = (points_[middle] - p).squaredNorm();
    if (here < *squared) {
      *squared = here;
      *best = middle;
    }
    const double beyond = p[axes_[middle]] - points_[middle][axes_[middle]];
    // Searches the near side by recursion and the far side iteratively, if it can be nearer.
    if (beyond < 0.0) {
      Search(first, middle, p, squared, best);
      first = middle + 1;
    } else {
      Search(middle + 1, last, p, squared, best);
      last = middle;
    }
    if (beyond * beyond >= *squared) return;
  }
}

const Eigen::Vector3d& PointTree::Nearest(const Eigen::Vector3d& p) const {
  double squared = std::numeric_limits<double>::infinity();
  size_t best = 0;
  Search(0, points_.size(), p, &squared, &best);
  return points_[best];
}

// Returns options for catalogue objects, which are shells with cracks, often without an underside:
// the interior that is accessible neither through an opening of a twentieth of the side nor from
// the floor is filled.
geometry::VoxelSolidOptions SolidOptions() {
  geometry::VoxelSolidOptions options;
  options.resolution = 96;
  options.gap_cells = 2.5;
  options.on_floor = true;
  return options;
}

ComparableShape::ComparableShape(const core::TriangleMesh& mesh, std::uint64_t seed) : mesh_(mesh) {
  core::RequireValid(mesh, "a shape to compare");
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) box.extend(mesh.vertices[static_cast<size_t>(triangle[k])]);
  }
  if (box.isEmpty() || !(box.sizes().maxCoeff() > 0.0)) {
    throw core::Error("a mesh without extent cannot be compared");
  }
  normal_from_mesh_ = ToUnitBox(box);
  core::Transform(normal_from_mesh_, &mesh_);
  points_ = geometry::SampleOuterSurface(mesh_, kRays, seed);
  if (points_.size() < 100) throw core::Error("hardly any ray hits the mesh");
  tree_ = std::make_unique<PointTree>(std::vector<Eigen::Vector3d>(
      points_.begin(), points_.begin() + static_cast<long>(Used(points_, kTreePoints))));
  surface_ = std::make_unique<geometry::TriangleTree>(mesh_);
  solid_ = std::make_unique<geometry::VoxelSolid>(mesh_, SolidOptions());
}

Eigen::Affine3d Align(const ComparableShape& truth, const ComparableShape& other) {
  const std::vector<Eigen::Matrix3d> rotations = SearchRotations();
  std::vector<Candidate> candidates(rotations.size());
  core::ParallelFor(static_cast<int>(rotations.size()), [&](int i) {
    Candidate& candidate = candidates[static_cast<size_t>(i)];
    candidate.truth_from_other = Turned(other, rotations[static_cast<size_t>(i)]);
    candidate.chamfer = PointChamfer(truth, other, candidate.truth_from_other, kSearchPoints);
  });
  const auto better = [](const Candidate& a, const Candidate& b) { return a.chamfer < b.chamfer; };
  std::stable_sort(candidates.begin(), candidates.end(), better);
  candidates.resize(kRefined);
  core::ParallelFor(kRefined, [&](int i) {
    Candidate& candidate = candidates[static_cast<size_t>(i)];
    candidate = Refined(truth, other, candidate.truth_from_other);
  });
  return std::min_element(candidates.begin(), candidates.end(), better)->truth_from_other;
}

Eigen::Affine3d AlignFrom(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Matrix3d& truth_from_other) {
  return Refined(truth, other, Turned(other, truth_from_other)).truth_from_other;
}

double TurningDefect(const ComparableShape& shape) {
  const Eigen::Vector3d centroid = std::accumulate(shape.points().begin(), shape.points().end(),
                                                   Eigen::Vector3d::Zero().eval()) /
                                   static_cast<double>(shape.points().size());
  return std::min(TurningDefectAbout(shape, Eigen::Vector3d::Zero()),
                  TurningDefectAbout(shape, centroid));
}

}  // namespace simwright::bench
