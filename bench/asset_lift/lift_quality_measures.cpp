#include "lift_quality_measures.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/surface_fairness.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::bench {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kNear = 0.1;
constexpr int kIouCells = 80;
constexpr int kViewSide = 256;
constexpr double kViewFov = 35.0 * kDegree;
// A unit box's farthest corner is sqrt(3) from its middle; most shapes extend half as far.
constexpr double kViewDistance = 5.0;

// The smallest mean deviation of a ground truth's normals that ours are compared with: 1 degree.
// A faceless sphere would make any reconstruction infinitely rough.
constexpr double kSmoothest = kDegree;

// The points of one shape against the surface of another.
struct SurfaceComparison {
  std::vector<double> distances;  // in the ground truth's frame
  std::vector<double> cosines;    // |cosine| between both normals
};

SurfaceComparison CompareSurfaces(const ComparableShape& from,
                                  const Eigen::Affine3d& surface_from_points,
                                  const ComparableShape& to, double scale) {
  const std::vector<Eigen::Vector3d>& points = from.points();
  SurfaceComparison compared{std::vector<double>(points.size()),
                             std::vector<double>(points.size())};
  const Eigen::Matrix3d turn = surface_from_points.rotation();
  constexpr size_t kBlock = 256;
  const int blocks = static_cast<int>((points.size() + kBlock - 1) / kBlock);
  core::ParallelFor(blocks, [&](int block) {
    const size_t first = static_cast<size_t>(block) * kBlock;
    for (size_t i = first; i < std::min(points.size(), first + kBlock); ++i) {
      const geometry::SurfacePoint own = from.surface().Closest(points[i]);
      const geometry::SurfacePoint near = to.surface().Closest(surface_from_points * points[i]);
      compared.distances[i] = scale * near.distance;
      compared.cosines[i] = std::abs(
          (turn * from.surface().Normal(own.triangle)).dot(to.surface().Normal(near.triangle)));
    }
  });
  return compared;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double ShareNear(const std::vector<double>& distances) {
  double near = 0.0;
  for (const double distance : distances) near += distance < kNear ? 1.0 : 0.0;
  return near / static_cast<double>(distances.size());
}

double VolumeIou(const ComparableShape& truth, const ComparableShape& other,
                 const Eigen::Affine3d& truth_from_other) {
  const Eigen::Affine3d other_from_truth = truth_from_other.inverse();
  Eigen::AlignedBox3d box = core::Bounds(truth.mesh());
  for (const Eigen::Vector3d& v : other.mesh().vertices) box.extend(truth_from_other * v);
  const double step = box.sizes().maxCoeff() / kIouCells;
  const Eigen::Array3i cells = (box.sizes().array() / step).ceil().cast<int>().max(1);
  std::vector<long> both(static_cast<size_t>(cells.z())), either(both.size());
  core::ParallelFor(cells.z(), [&](int k) {
    for (int j = 0; j < cells.y(); ++j) {
      for (int i = 0; i < cells.x(); ++i) {
        const Eigen::Vector3d p = box.min() + step * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
        const bool a = truth.solid().Occupancy(p) > 0.5f;
        const bool b = other.solid().Occupancy(other_from_truth * p) > 0.5f;
        both[static_cast<size_t>(k)] += a && b ? 1 : 0;
        either[static_cast<size_t>(k)] += a || b ? 1 : 0;
      }
    }
  });
  double shared = 0.0, whole = 0.0;
  for (size_t k = 0; k < both.size(); ++k) {
    shared += static_cast<double>(both[k]);
    whole += static_cast<double>(either[k]);
  }
  return whole > 0.0 ? shared / whole : 0.0;
}

core::Image OverWhite(const core::Image& rgba) {
  core::Image opaque(rgba.width, rgba.height, 3);
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      const std::uint8_t* p = rgba.At(x, y);
      for (int c = 0; c < 3; ++c) {
        opaque.At(x, y)[c] = static_cast<std::uint8_t>((p[3] * p[c] + (255 - p[3]) * 255) / 255);
      }
    }
  }
  return opaque;
}

}  // namespace

ShapeScores CompareShapes(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Affine3d& truth_from_other) {
  const double scale = std::cbrt(truth_from_other.linear().determinant());
  const SurfaceComparison from_other = CompareSurfaces(other, truth_from_other, truth, 1.0);
  const SurfaceComparison from_truth =
      CompareSurfaces(truth, truth_from_other.inverse(), other, scale);
  ShapeScores scores;
  scores.chamfer = 0.5 * (Mean(from_other.distances) + Mean(from_truth.distances));
  scores.normal_consistency = 0.5 * (Mean(from_other.cosines) + Mean(from_truth.cosines));
  scores.roughness = geometry::MeasureFairness(other.mesh()).mean_deviation /
                     std::max(kSmoothest, geometry::MeasureFairness(truth.mesh()).mean_deviation);
  const double precision = ShareNear(from_other.distances),
               recall = ShareNear(from_truth.distances);
  scores.f_score = precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0;
  scores.volume_iou = VolumeIou(truth, other, truth_from_other);
  return scores;
}

std::vector<core::Image> NovelViews(const core::TexturedMesh& in_unit_box, double photo_azimuth,
                                    bool lit) {
  render::Scene scene;
  scene.Add(&in_unit_box);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = lit;
  options.occlusion_rays = lit ? 8 : 0;  // as in MakePhoto
  std::vector<core::Image> views;
  for (const double round : {45.0, 135.0, 225.0, 315.0}) {
    const core::Camera camera =
        core::OrbitCamera(Eigen::Vector3d::Zero(), kViewDistance, 20.0 * kDegree,
                          photo_azimuth + round * kDegree, kViewFov, kViewSide, kViewSide);
    views.push_back(OverWhite(render::RenderForward(scene, camera, options).color));
  }
  return views;
}

double PeakSignalToNoise(const core::Image& a, const core::Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.empty()) {
    throw core::Error("images to compare differ in size");
  }
  double squared = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = static_cast<double>(a.pixels[i]) - b.pixels[i];
    squared += difference * difference;
  }
  const double mean = squared / static_cast<double>(a.pixels.size());
  return mean > 0.0 ? std::min(99.0, 10.0 * std::log10(255.0 * 255.0 / mean)) : 99.0;
}

core::TexturedMesh Moved(core::TexturedMesh mesh, const Eigen::Affine3d& to) {
  core::Transform(to, &mesh.mesh);
  return mesh;
}

}  // namespace simwright::bench
