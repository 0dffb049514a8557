#include "capture/structure_adjustment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "capture/brown_conrady.h"
#include "capture/track_triangulation.h"

namespace simwright::capture {
namespace {

constexpr double kHuberLoss = 1.0;     // pixels
constexpr double kWrongMatch = 100.0;  // pixels: it would not come right by an adjustment
constexpr int kPhotosForLens = 3;
constexpr double kFocalRange = 3.0;       // factor by which the focal length may leave its start
constexpr double kExifDeviation = 0.1;    // of EXIF's focal length, relative
constexpr double kCenterSpread = 0.01;    // of the principal point, in longer sides
constexpr double kRadialSpread = 0.3;     // of the radial coefficients
constexpr double kTangentSpread = 0.003;  // of the tangential coefficients

struct PointError {
  Eigen::Vector2d pixel;

  template <typename T>
  bool operator()(const T* lens, const T* rotation, const T* translation, const T* point,
                  T* residual) const {
    T at[3];
    ceres::AngleAxisRotatePoint(rotation, point, at);
    for (int k = 0; k < 3; ++k) at[k] += translation[k];
    if (at[2] <= T(1e-9)) return false;
    ProjectByLens(lens, at, residual);
    residual[0] -= T(pixel.x());
    residual[1] -= T(pixel.y());
    return true;
  }
};

// Keeps the values of a lens near their usual ones where the points do not determine them.
struct LensSpread {
  std::array<double, kLensValues> usual{};
  std::array<double, kLensValues> spread{};  // 0: free

  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    for (std::size_t k = 0; k < kLensValues; ++k) {
      residual[k] = spread[k] > 0.0 ? (lens[k] - T(usual[k])) / T(spread[k]) : T(0.0);
    }
    return true;
  }
};

// A structure in the form that Ceres changes.
class Adjustment {
 public:
  Adjustment(LensFit fit, const std::vector<double>& focal_priors, Structure* structure)
      : fit_(fit), focal_priors_(focal_priors), structure_(structure) {
    for (const Lens& lens : structure->lenses) {
      lenses_.push_back({lens.fx, lens.cx, lens.cy, lens.k1, lens.k2, lens.p1, lens.p2, lens.k3});
    }
    for (const Structure::View& view : structure->views) {
      const Eigen::Isometry3d camera_from_world = view.world_from_camera.inverse();
      const Eigen::AngleAxisd turn(camera_from_world.linear());
      const Eigen::Vector3d rotation = turn.angle() * turn.axis();
      rotations_.push_back({rotation.x(), rotation.y(), rotation.z()});
      const Eigen::Vector3d t = camera_from_world.translation();
      translations_.push_back({t.x(), t.y(), t.z()});
    }
    for (const Structure::Point& point : structure->points) points_.push_back(point.position);
  }

  void Run() {
    AddObservations();
    KeepGauge();
    RestrictLenses();
    ceres::Solver::Options options;
    // The reduced matrix has six rows a photo, and most photos of an orbit share points.
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.dense_linear_algebra_library_type = ceres::EIGEN;
    options.max_num_iterations = fit_ == LensFit::kFull ? 40 : 15;
    options.function_tolerance = fit_ == LensFit::kFull ? 1e-7 : 1e-5;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (summary.IsSolutionUsable()) TakeOver();
  }

 private:
  void AddObservations() {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const FeatureTrack& track =
          structure_->tracks[static_cast<std::size_t>(structure_->points[p].track)];
      for (std::size_t k = 0; k < track.photos.size(); ++k) {
        const auto photo = static_cast<std::size_t>(track.photos[k]);
        const Structure::View& view = structure_->views[photo];
        if (!view.registered) continue;
        if (!(ReprojectionError(*structure_, track.photos[k], track.pixels[k], points_[p]) <
              kWrongMatch)) {
          continue;
        }
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<PointError, 2, kLensValues, 3, 3, 3>(
                new PointError{track.pixels[k]}),
            new ceres::HuberLoss(kHuberLoss), lenses_[static_cast<std::size_t>(view.lens)].data(),
            rotations_[photo].data(), translations_[photo].data(), points_[p].data());
      }
    }
  }

  // The first placed photo does not move, and the second one keeps its distance from the origin.
  void KeepGauge() {
    int placed = 0;
    for (std::size_t i = 0; i < structure_->views.size() && placed < 2; ++i) {
      if (!structure_->views[i].registered || !problem_.HasParameterBlock(rotations_[i].data())) {
        continue;
      }
      if (placed++ == 0) {
        problem_.SetParameterBlockConstant(rotations_[i].data());
        problem_.SetParameterBlockConstant(translations_[i].data());
      } else if (Eigen::Map<Eigen::Vector3d>(translations_[i].data()).norm() > 1e-6) {
        problem_.SetManifold(translations_[i].data(), new ceres::SphereManifold<3>());
      }
    }
  }

  void RestrictLenses() {
    for (std::size_t l = 0; l < lenses_.size(); ++l) {
      double* lens = lenses_[l].data();
      if (!problem_.HasParameterBlock(lens)) continue;
      const auto count = std::count_if(structure_->views.begin(), structure_->views.end(),
                                       [&](const Structure::View& view) {
                                         return view.registered && view.lens == static_cast<int>(l);
                                       });
      if (count < kPhotosForLens) {
        problem_.SetParameterBlockConstant(lens);
        continue;
      }
      std::vector<int> kept = {kK3};
      if (fit_ == LensFit::kUsual) kept = {kCenterX, kCenterY, kP1, kP2, kK3};
      problem_.SetManifold(lens, new ceres::SubsetManifold(kLensValues, kept));
      problem_.SetParameterLowerBound(lens, kFocal, lens[kFocal] / kFocalRange);
      problem_.SetParameterUpperBound(lens, kFocal, lens[kFocal] * kFocalRange);
      AddLensPrior(l);
    }
  }

  void AddLensPrior(std::size_t l) {
    const Lens& start = structure_->lenses[l];
    const double longer = std::max(start.width, start.height);
    LensSpread prior;
    prior.usual[kCenterX] = 0.5 * start.width;
    prior.usual[kCenterY] = 0.5 * start.height;
    prior.spread[kCenterX] = prior.spread[kCenterY] = kCenterSpread * longer;
    prior.usual[kFocal] = focal_priors_[l];
    prior.spread[kFocal] = kExifDeviation * focal_priors_[l];
    prior.spread[kK1] = prior.spread[kK2] = kRadialSpread;
    prior.spread[kP1] = prior.spread[kP2] = kTangentSpread;
    problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<LensSpread, kLensValues, kLensValues>(
                                  new LensSpread(prior)),
                              nullptr, lenses_[l].data());
  }

  void TakeOver() {
    for (std::size_t l = 0; l < lenses_.size(); ++l) {
      Lens& lens = structure_->lenses[l];
      lens.fx = lens.fy = lenses_[l][kFocal];
      lens.k1 = lenses_[l][kK1];
      lens.k2 = lenses_[l][kK2];
      lens.cx = lenses_[l][kCenterX];
      lens.cy = lenses_[l][kCenterY];
      lens.p1 = lenses_[l][kP1];
      lens.p2 = lenses_[l][kP2];
    }
    for (std::size_t i = 0; i < rotations_.size(); ++i) {
      const Eigen::Vector3d rotation(rotations_[i].data());
      Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
      if (rotation.norm() > 0.0) {
        camera_from_world.linear() =
            Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
      }
      camera_from_world.translation() = Eigen::Vector3d(translations_[i].data());
      structure_->views[i].world_from_camera = camera_from_world.inverse();
    }
    for (std::size_t p = 0; p < points_.size(); ++p) structure_->points[p].position = points_[p];
  }

  LensFit fit_;
  const std::vector<double>& focal_priors_;
  Structure* structure_;
  std::vector<std::array<double, kLensValues>> lenses_;
  std::vector<std::array<double, 3>> rotations_, translations_;  // camera_from_world
  std::vector<Eigen::Vector3d> points_;
  ceres::Problem problem_;
};

}  // namespace

void AdjustStructure(LensFit fit, const std::vector<double>& focal_priors, Structure* structure) {
  if (structure->points.empty()) return;
  Adjustment(fit, focal_priors, structure).Run();
}

Eigen::Vector2d DirectionOf(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d wanted((pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy);
  Eigen::Vector2d at = wanted;
  for (int i = 0; i < 15; ++i) {
    const Eigen::Vector2d shown = lens.Project({at.x(), at.y(), 1.0});
    at +=
        wanted - Eigen::Vector2d((shown.x() - lens.cx) / lens.fx, (shown.y() - lens.cy) / lens.fy);
  }
  return at;
}

}  // namespace simwright::capture
