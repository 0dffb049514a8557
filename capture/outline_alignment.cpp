#include "capture/outline_alignment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "geometry/mass_properties.h"
#include "geometry/surface_distance.h"

namespace simwright::capture {
namespace {

constexpr int kDistanceCells = 64;        // of a hull's distance grid
constexpr int kRaysPerView = 48;          // through a view's outline
constexpr double kNearHull = 1.5;         // cells, of a ray's points from its own hull
constexpr int kSurfaceSamples = 400;      // of a hull
constexpr int kRotations = 3000;          // about 16 degrees from each other
constexpr std::size_t kCoarsePoses = 96;  // that are refined
constexpr double kDistinct = 12.0 * std::numbers::pi / 180.0;
// The deviations of the robust loss, in diagonals, and the steps with each.
constexpr std::pair<double, int> kCoarseSteps[] = {{0.06, 6}, {0.03, 6}};
constexpr std::pair<double, int> kFineSteps[] = {{0.03, 6}, {0.012, 8}, {0.005, 12}};

// Returns the pixels of the mask's outline that are not on the photo's border, thinned.
std::vector<Eigen::Vector2d> OutlinePixels(const core::FloatImage& mask) {
  std::vector<Eigen::Vector2d> outline;
  for (int y = 2; y + 2 < mask.height; ++y) {
    for (int x = 2; x + 2 < mask.width; ++x) {
      if (*mask.At(x, y) < 0.5f) continue;
      const bool edge = *mask.At(x - 1, y) < 0.5f || *mask.At(x + 1, y) < 0.5f ||
                        *mask.At(x, y - 1) < 0.5f || *mask.At(x, y + 1) < 0.5f;
      if (edge) outline.emplace_back(x + 0.5, y + 0.5);
    }
  }
  if (outline.size() <= kRaysPerView) return outline;
  std::vector<Eigen::Vector2d> thinned;
  for (std::size_t i = 0; i < kRaysPerView; ++i) {
    thinned.push_back(outline[i * outline.size() / kRaysPerView]);
  }
  return thinned;
}

// The smallest distance of a ray's points to the other hull, where it is, and its derivative by a
// motion (rotation about `center`, then translation) of the other frame's points.
struct RayMiss {
  double distance = 0.0;
  Eigen::Vector3d point, gradient;
};

RayMiss MissOf(const std::vector<Eigen::Vector3d>& ray, const Eigen::Isometry3d& other_from_ray,
               const DistanceGrid& other) {
  RayMiss miss;
  miss.distance = 1e9;
  for (const Eigen::Vector3d& point : ray) {
    const Eigen::Vector3d at = other_from_ray * point;
    const double distance = other.At(at);
    if (distance >= miss.distance) continue;
    miss.distance = distance;
    miss.point = at;
  }
  other.At(miss.point, &miss.gradient);
  return miss;
}

// Sums of a Gauss-Newton step.
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();

  // Both signs of a miss are weighted down where they exceed the deviation: a hull exceeds the
  // object where its photos do not show it.
  void Add(double miss, double deviation, const Eigen::Matrix<double, 6, 1>& jacobian) {
    const double ratio = miss / (miss > 0.0 ? 2.0 * deviation : deviation);
    const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
    matrix += weight * jacobian * jacobian.transpose();
    right -= weight * miss * jacobian;
  }
};

// Moves a pose by one step. The motion acts in the first frame, about the first hull's centre;
// angles count in half diagonals.
void Step(const OutlineSet& first, const OutlineSet& second, double deviation, int stride,
          Eigen::Isometry3d* pose) {
  NormalEquations sums;
  const double arm = 0.5 * first.diagonal;
  const Eigen::Isometry3d inverse = pose->inverse();
  for (std::size_t i = 0; i < second.rays.size(); i += stride) {
    const RayMiss miss = MissOf(second.rays[i], *pose, first.distance);
    Eigen::Matrix<double, 6, 1> jacobian;
    jacobian << (miss.point - first.center).cross(miss.gradient) / arm, miss.gradient;
    sums.Add(miss.distance, deviation, jacobian);
  }
  for (std::size_t i = 0; i < first.rays.size(); i += stride) {
    const RayMiss miss = MissOf(first.rays[i], inverse, second.distance);
    const Eigen::Vector3d gradient = pose->linear() * miss.gradient;
    Eigen::Matrix<double, 6, 1> jacobian;
    jacobian << -(*pose * miss.point - first.center).cross(gradient) / arm, -gradient;
    sums.Add(miss.distance, deviation, jacobian);
  }
  sums.matrix.diagonal().array() += 1e-3 * sums.matrix.trace() / 6.0;
  const Eigen::Matrix<double, 6, 1> step = sums.matrix.ldlt().solve(sums.right);
  const Eigen::Vector3d turn = step.head<3>() / arm;
  const double angle = std::min(turn.norm(), 0.3);
  const Eigen::AngleAxisd rotation(
      angle, angle > 1e-12 ? Eigen::Vector3d(turn.normalized()) : Eigen::Vector3d::UnitZ());
  *pose = Eigen::Translation3d(first.center + step.tail<3>()) * rotation *
          Eigen::Translation3d(-first.center) * *pose;
  pose->linear() = Eigen::Quaterniond(pose->linear()).normalized().toRotationMatrix();
}

double Mismatch(const OutlineSet& first, const OutlineSet& second, const Eigen::Isometry3d& pose) {
  double sum = 0.0;
  const double most = kMostMismatch * first.diagonal;
  const Eigen::Isometry3d inverse = pose.inverse();
  for (const auto& ray : second.rays) {
    sum += std::clamp(MissOf(ray, pose, first.distance).distance, 0.0, most);
  }
  for (const auto& ray : first.rays) {
    sum += std::clamp(MissOf(ray, inverse, second.distance).distance, 0.0, most);
  }
  return sum / (static_cast<double>(first.rays.size() + second.rays.size()) * first.diagonal);
}

// Returns the mean distance of the hulls' surfaces from each other, m.
double HullDistance(const OutlineSet& first, const OutlineSet& second,
                    const Eigen::Isometry3d& pose) {
  double sum = 0.0;
  const Eigen::Isometry3d inverse = pose.inverse();
  for (const Eigen::Vector3d& p : second.surface) sum += std::abs(first.distance.At(pose * p));
  for (const Eigen::Vector3d& p : first.surface) sum += std::abs(second.distance.At(inverse * p));
  return sum / static_cast<double>(first.surface.size() + second.surface.size());
}

Eigen::Quaterniond UniformRotation(core::Rng& rng) {
  Eigen::Vector4d q(core::Normal(rng), core::Normal(rng), core::Normal(rng), core::Normal(rng));
  return Eigen::Quaterniond(q.normalized());
}

bool IsDistinct(const Eigen::Isometry3d& pose, const std::vector<OutlinePose>& from) {
  return std::all_of(from.begin(), from.end(), [&](const OutlinePose& other) {
    return Eigen::Quaterniond(pose.linear())
               .angularDistance(Eigen::Quaterniond(other.first_from_second.linear())) > kDistinct;
  });
}

void SortByMismatch(std::vector<OutlinePose>* poses) {
  std::stable_sort(poses->begin(), poses->end(), [](const OutlinePose& a, const OutlinePose& b) {
    return a.mismatch < b.mismatch;
  });
}

}  // namespace

OutlineSet OutlinesOf(const Capture& capture) {
  const geometry::MassProperties mass = geometry::SolidMassProperties(capture.hull, 1.0);
  OutlineSet set{{},
                 geometry::SampleSurface(capture.hull, kSurfaceSamples, 1),
                 DistanceGrid(capture.hull, kDistanceCells),
                 mass.center_of_mass,
                 core::Bounds(capture.hull).diagonal().norm()};
  const double cell = set.distance.cell();
  for (const CaptureView& view : capture.views) {
    for (const Eigen::Vector2d& pixel : OutlinePixels(view.opacity)) {
      const Eigen::Vector3d direction = view.camera.Ray(pixel).normalized();
      const double middle = direction.dot(set.center - view.camera.position());
      std::vector<Eigen::Vector3d> near;
      for (double t = -set.diagonal; t <= set.diagonal; t += 0.5 * cell) {
        const Eigen::Vector3d point = view.camera.position() + (middle + t) * direction;
        if (set.distance.At(point) < kNearHull * cell) near.push_back(point);
      }
      if (!near.empty()) set.rays.push_back(std::move(near));
    }
  }
  return set;
}

OutlinePose RefineByOutlines(const OutlineSet& first, const OutlineSet& second, OutlinePose pose) {
  for (const auto& [deviation, steps] : kFineSteps) {
    for (int i = 0; i < steps; ++i) {
      Step(first, second, deviation * first.diagonal, 1, &pose.first_from_second);
    }
  }
  pose.mismatch = Mismatch(first, second, pose.first_from_second);
  return pose;
}

std::vector<OutlinePose> AlignOutlines(const OutlineSet& first, const OutlineSet& second, int count,
                                       std::uint64_t seed) {
  std::vector<OutlinePose> coarse(kRotations);
  core::ParallelFor(kRotations, [&](int i) {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    OutlinePose& pose = coarse[static_cast<std::size_t>(i)];
    pose.first_from_second = Eigen::Translation3d(first.center) * UniformRotation(rng) *
                             Eigen::Translation3d(-second.center);
    pose.mismatch = HullDistance(first, second, pose.first_from_second);
  });
  SortByMismatch(&coarse);
  coarse.resize(std::min(coarse.size(), kCoarsePoses));
  core::ParallelFor(static_cast<int>(coarse.size()), [&](int i) {
    OutlinePose& pose = coarse[static_cast<std::size_t>(i)];
    for (const auto& [deviation, steps] : kCoarseSteps) {
      for (int k = 0; k < steps; ++k) {
        Step(first, second, deviation * first.diagonal, 4, &pose.first_from_second);
      }
    }
    pose.mismatch = Mismatch(first, second, pose.first_from_second);
  });
  SortByMismatch(&coarse);
  std::vector<OutlinePose> poses;
  for (const OutlinePose& pose : coarse) {
    if (static_cast<int>(poses.size()) >= count) break;
    if (IsDistinct(pose.first_from_second, poses)) poses.push_back(pose);
  }
  core::ParallelFor(static_cast<int>(poses.size()), [&](int i) {
    OutlinePose& pose = poses[static_cast<std::size_t>(i)];
    pose = RefineByOutlines(first, second, pose);
  });
  SortByMismatch(&poses);
  std::vector<OutlinePose> distinct;
  for (const OutlinePose& pose : poses) {
    if (IsDistinct(pose.first_from_second, distinct)) distinct.push_back(pose);
  }
  return distinct;
}

}  // namespace simwright::capture
