#include "twin/table_depth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "core/random.h"

namespace simwright::twin {
namespace {

constexpr double kDepthAspectTolerance = 0.01;  // relative
constexpr double kLeastMeasured = 0.02;         // of the pixels
constexpr std::size_t kMostPlanePoints = 20000;
constexpr int kPlaneTrials = 800;
constexpr double kPlaneReach = 0.005, kPlaneReachGrowth = 0.004;  // m, and per m of depth
constexpr double kLeastPlaneShare = 0.12;
constexpr double kSamePlaneCosine = 0.966;  // of 15 degrees
constexpr int kPlaneRefinements = 8;
constexpr double kPlaneDeviations = 3.0;
constexpr double kLeastPlaneError = 4e-4;    // m, of depth in whole millimetres
constexpr double kNormalDeviation = 1.4826;  // over the median of absolute deviations
constexpr double kRadianInDegrees = 180.0 / M_PI;

// A plane normal . p + height = 0 in the camera's frame; the camera is on the normal's side.
struct CameraPlane {
  Eigen::Vector3d normal{0, -1, 0};
  double height = 0.0;

  double HeightOf(const Eigen::Vector3d& point) const { return normal.dot(point) + height; }
};

// The optical axis meets the plane at `elevation`; in the picture the plane's normal is upright.
TableCamera CameraAbove(const CameraPlane& plane, const TableCamera& lens) {
  TableCamera camera = lens;
  camera.elevation = std::asin(std::clamp(-plane.normal.z(), -1.0, 1.0));
  camera.roll = std::atan2(-plane.normal.x(), -plane.normal.y());
  camera.height = plane.height;
  return camera;
}

std::vector<Eigen::Vector3d> PointsOf(const core::FloatImage& depth, const TableCamera& lens) {
  const core::Camera camera = lens.At(depth.width, depth.height);
  std::size_t measured = 0;
  for (const float value : depth.values) measured += value > 0.0f ? 1 : 0;
  const std::size_t stride = std::max<std::size_t>(1, measured / kMostPlanePoints);
  std::vector<Eigen::Vector3d> points;
  std::size_t index = 0;
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const double z = *depth.At(x, y);
      if (!(z > 0.0) || index++ % stride != 0) continue;
      points.emplace_back((x + 0.5 - camera.cx) / camera.fx * z,
                          (y + 0.5 - camera.cy) / camera.fy * z, z);
    }
  }
  return points;
}

bool PlaneThrough(const std::vector<Eigen::Vector3d>& points, core::Rng* rng, CameraPlane* plane) {
  const auto draw = [&] {
    return points[static_cast<std::size_t>(
        core::UniformIndex(*rng, static_cast<std::int64_t>(points.size())))];
  };
  const Eigen::Vector3d a = draw(), b = draw(), c = draw();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(normal.norm() > 1e-6)) return false;
  plane->normal = normal.normalized();
  plane->height = -plane->normal.dot(a);
  if (plane->height < 0.0) {
    plane->normal = -plane->normal;
    plane->height = -plane->height;
  }
  return true;
}

std::size_t CountOnPlane(const std::vector<Eigen::Vector3d>& points, const CameraPlane& plane) {
  std::size_t count = 0;
  for (const Eigen::Vector3d& point : points) {
    const double reach = kPlaneReach + kPlaneReachGrowth * point.z();
    count += std::abs(plane.HeightOf(point)) < reach ? 1 : 0;
  }
  return count;
}

// Returns the standard deviation of the heights within `reach`, robust to the points of objects.
double HeightDeviation(const std::vector<Eigen::Vector3d>& points, const CameraPlane& plane,
                       double reach) {
  std::vector<double> off;
  for (const Eigen::Vector3d& point : points) {
    const double height = std::abs(plane.HeightOf(point));
    if (height < reach) off.push_back(height);
  }
  if (off.empty()) return kLeastPlaneError;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return std::max(kLeastPlaneError, kNormalDeviation * *middle);
}

CameraPlane LeastSquaresPlane(const std::vector<Eigen::Vector3d>& points, const CameraPlane& before,
                              double reach) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(before.HeightOf(point)) >= reach) continue;
    mean += point;
    products += point * point.transpose();
    ++count;
  }
  if (count < 3) return before;
  mean /= static_cast<double>(count);
  const Eigen::Matrix3d covariance =
      products / static_cast<double>(count) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  CameraPlane plane;
  plane.normal = axes.eigenvectors().col(0).normalized();
  if (plane.normal.dot(before.normal) < 0.0) plane.normal = -plane.normal;
  plane.height = -plane.normal.dot(mean);
  return plane;
}

[[noreturn]] void FailWithoutPlane(const CameraPlane& largest, std::size_t count,
                                   std::size_t points, const TableCamera& lens,
                                   const std::string& where) {
  const TableCamera seen = CameraAbove(largest, lens);
  char sentence[240];
  std::snprintf(sentence, sizeof sentence,
                "the depth shows no table: the largest plane holds %.0f %% of the pixels, and the "
                "camera would look onto it %.0f degrees from above, rolled by %.0f degrees, from "
                "%.2f m",
                100.0 * static_cast<double>(count) / static_cast<double>(points),
                kRadianInDegrees * seen.elevation, kRadianInDegrees * seen.roll, seen.height);
  throw core::Error(sentence, where,
                    "take the photo of a table from 3 to 88 degrees above; a wall is none");
}

}  // namespace

core::FloatImage DepthOfPhoto(const core::FloatImage& depth, int width, int height,
                              const std::string& where) {
  const double aspect = static_cast<double>(depth.width) / depth.height * height / width;
  if (std::abs(aspect - 1.0) > kDepthAspectTolerance) {
    throw core::Error("the depth image has " + std::to_string(depth.width) + " x " +
                          std::to_string(depth.height) + " pixels, another aspect than the photo",
                      where, "give the depth that is registered to the photo");
  }
  core::FloatImage of_photo(width, height, 1);
  std::size_t measured = 0;
  for (int y = 0; y < height; ++y) {
    const int from_y =
        std::min(depth.height - 1, static_cast<int>((y + 0.5) * depth.height / height));
    for (int x = 0; x < width; ++x) {
      const int from_x =
          std::min(depth.width - 1, static_cast<int>((x + 0.5) * depth.width / width));
      const float value = *depth.At(from_x, from_y);
      if (!(value > 0.0f) || !std::isfinite(value)) continue;
      *of_photo.At(x, y) = value;
      ++measured;
    }
  }
  if (static_cast<double>(measured) < kLeastMeasured * width * height) {
    throw core::Error(measured == 0 ? "no pixel of the depth image is measured: all are 0"
                                    : "fewer than 2 % of the depth image's pixels are measured",
                      where, "give the depth of this photo");
  }
  return of_photo;
}

DepthPlane FitTablePlane(const core::FloatImage& depth, const TableCamera& lens, std::uint64_t seed,
                         const std::string& where) {
  const std::vector<Eigen::Vector3d> points = PointsOf(depth, lens);
  if (points.size() < 100) throw core::Error("fewer than 100 pixels have a depth", where);
  core::Rng rng = core::StreamRng(seed, 77);
  CameraPlane table, other;
  std::size_t of_table = 0, of_other = 0;
  for (int trial = 0; trial < kPlaneTrials; ++trial) {
    CameraPlane plane;
    if (!PlaneThrough(points, &rng, &plane)) continue;
    const bool is_table = CameraAbove(plane, lens).IsValid(nullptr);
    const std::size_t count = CountOnPlane(points, plane);
    std::size_t& most = is_table ? of_table : of_other;
    if (count <= most) continue;
    most = count;
    (is_table ? table : other) = plane;
  }
  const auto total = static_cast<double>(points.size());
  // The points of a wall also agree with planes tilted against it, within the range of tables.
  const bool is_wall = of_other > of_table && table.normal.dot(other.normal) > kSamePlaneCosine;
  if (is_wall || static_cast<double>(of_table) < kLeastPlaneShare * total) {
    const bool largest = of_table > of_other;
    FailWithoutPlane(largest ? table : other, std::max(of_table, of_other), points.size(), lens,
                     where);
  }
  DepthPlane fitted;
  double reach = 2.0 * (kPlaneReach + kPlaneReachGrowth * 1.0);
  for (int step = 0; step < kPlaneRefinements; ++step) {
    table = LeastSquaresPlane(points, table, reach);
    fitted.error = HeightDeviation(points, table, reach);
    reach = kPlaneDeviations * fitted.error;
  }
  fitted.camera = CameraAbove(table, lens);
  std::string fault;
  if (!fitted.camera.IsValid(&fault)) throw core::Error(fault, where);
  fitted.share = static_cast<double>(CountOnPlane(points, table)) / total;
  return fitted;
}

}  // namespace simwright::twin
