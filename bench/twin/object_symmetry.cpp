#include "object_symmetry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/random.h"

namespace simwright::bench {
namespace {

constexpr int kSurfacePoints = 600, kCompared = 200, kTurns = 72;
constexpr double kTolerance = 0.037;  // of the diagonal

std::vector<Eigen::Vector3d> SurfacePoints(const core::TriangleMesh& mesh) {
  std::vector<double> area;
  double sum = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    sum += core::TriangleAreaVector(mesh, t).norm();
    area.push_back(sum);
  }
  core::Rng rng(7);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kSurfacePoints; ++i) {
    const auto at = std::lower_bound(area.begin(), area.end(), core::Uniform(rng) * sum);
    const Eigen::Vector3i& corners = mesh.triangles[static_cast<size_t>(
        std::min<std::ptrdiff_t>(at - area.begin(), static_cast<std::ptrdiff_t>(area.size()) - 1))];
    double u = core::Uniform(rng), v = core::Uniform(rng);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto corner = [&](int k) { return mesh.vertices[static_cast<size_t>(corners[k])]; };
    points.push_back((1.0 - u - v) * corner(0) + u * corner(1) + v * corner(2));
  }
  return points;
}

}  // namespace

std::vector<double> SymmetricTurns(const core::TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3d> points = SurfacePoints(mesh);
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  std::vector<double> turns{0.0};
  for (int k = 1; k < kTurns; ++k) {
    const double turn = 2.0 * M_PI * k / kTurns;
    const Eigen::AngleAxisd rotation(turn, Eigen::Vector3d::UnitZ());
    double sum = 0.0;
    for (int i = 0; i < kCompared; ++i) {
      const Eigen::Vector3d moved =
          box.center() +
          rotation * (points[static_cast<size_t>(i * kSurfacePoints / kCompared)] - box.center());
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& point : points) {
        nearest = std::min(nearest, (moved - point).squaredNorm());
      }
      sum += std::sqrt(nearest);
    }
    if (sum / kCompared < kTolerance * box.diagonal().norm()) turns.push_back(turn);
  }
  return turns;
}

double YawDifference(double yaw, double truth, const std::vector<double>& turns) {
  double least = M_PI;
  for (const double turn : turns) {
    least = std::min(least, std::abs(std::remainder(yaw - truth - turn, 2.0 * M_PI)));
  }
  return least;
}

}  // namespace simwright::bench
