#include "asset_lift/outline/inflation.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "asset_lift/camera/depth_map.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "asset_lift/outline/missing_parts.h"
#include "asset_lift/outline/outline_field.h"
#include "asset_lift/outline/upright_body.h"
#include "core/error.h"
#include "core/progress.h"
#include "geometry/mass_properties.h"
#include "geometry/simplify.h"
#include "geometry/stable_poses.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

double InflationReach(const core::TriangleMesh& mesh, const Eigen::Vector3d& direction) {
  double reach = -1e300;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    reach = std::max(reach, vertex.dot(direction));
  }
  return reach;
}

// Returns the direction, near straight down, in which the surface is nearest to the centre of mass:
// a body at rest has a locally lowest centre of mass. Returns straight down if there is none within
// 25 degrees.
Eigen::Vector3d SupportDirection(const core::TriangleMesh& mesh, const Eigen::Vector3d& center) {
  const Eigen::Vector3d straight = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d down = straight;
  double height = InflationReach(mesh, down) - down.dot(center);
  for (double step = 0.1; step > 0.005;) {
    const Eigen::Vector3d u = down.unitOrthogonal(), v = down.cross(u);
    Eigen::Vector3d best = down;
    for (int i = 0; i < 16; ++i) {
      const double angle = 2.0 * M_PI * i / 16;
      const Eigen::Vector3d tried =
          (down + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
      const double lower = InflationReach(mesh, tried) - tried.dot(center);
      // A gain too small to turn a real body is a roll about its own axis, not settling.
      if (lower < height - 0.02 * step * std::abs(height)) {
        height = lower;
        best = tried;
      }
    }
    if (best == down) step *= 0.5;
    down = best;
    if (down.dot(straight) < 0.906) return straight;
  }
  return down;
}

class Inflater {
 public:
  Inflater(const Matte& matte, const core::Camera& camera, const CategoryPrior& prior,
           const InflationOptions& options)
      : matte_(matte),
        camera_(camera),
        prior_(prior),
        options_(options),
        mask_(MaskOfMatte(matte)) {}

  InflatedShape Inflate() const {
    std::vector<InflatedShape> shapes;
    // Fruit and balls are round at both ends in every pose: no discs, no rim.
    if (!prior_.round) {
      const UprightBody body = FitUprightBody(mask_, camera_);
      if (body.coverage >=
          (prior_.revolved ? options_.revolved_coverage : options_.plain_coverage)) {
        shapes.push_back(Upright(body));
      }
    }
    if (shapes.empty() || shapes[0].silhouette_iou < 0.97) {
      const MirrorAxis axis = FindMirrorAxis(mask_);
      if (axis.agreement > (prior_.round ? 0.85 : 0.93)) {
        shapes.push_back(
            Flat(ShapeForm::kLying, RevolvedDepth(mask_, axis.center, axis.direction)));
      }
    }
    if (shapes.empty() || shapes.back().silhouette_iou < 0.97) {
      shapes.push_back(Flat(ShapeForm::kInflated, PoissonDepth(mask_)));
    }
    // The first form that fits well is the most specific one; otherwise the best fit is used.
    for (InflatedShape& shape : shapes) {
      if (shape.silhouette_iou >= 0.97) return std::move(shape);
    }
    return *std::max_element(shapes.begin(), shapes.end(), [](const auto& a, const auto& b) {
      return a.silhouette_iou < b.silhouette_iou;
    });
  }

 private:
  InflatedShape Upright(UprightBody body) const {
    if (prior_.open) RestoreRim(mask_, camera_, &body);
    OutlineField field(camera_, mask_);
    field.AddUprightBody(body);
    if (prior_.open && !prior_.round) {
      field.HollowUprightBody(body, 2.0 * body.MaxRadius() * options_.wall_ratio);
    }
    const cv::Mat rest =
        UncoveredParts(mask_, Silhouette(body, camera_), matte_.right - matte_.left);
    if (cv::countNonZero(rest) > 0) {
      field.AddDepthMap(PoissonDepth(rest), {body.axis_x, body.axis_y, 0.0});
    }
    const Eigen::Hyperplane<double, 3> mirror(Eigen::Vector3d::UnitY(),
                                              Eigen::Vector3d(0, body.axis_y, 0));
    // The body stands on a flat base: the silhouette below it is cut off level, at the highest
    // level that keeps the silhouette IoU.
    InflatedShape shape;
    for (int lowered = 0; lowered < 4 && shape.silhouette_iou < 0.97; ++lowered) {
      const double spare = 0.025 * lowered * (body.top() - body.bottom);
      field.Cut(-Eigen::Vector3d::UnitZ(), -(body.bottom - spare));
      shape =
          Finish(ShapeForm::kUpright, LargeComponents(field.Extract(options_.resolution)), mirror);
    }
    return shape;
  }

  InflatedShape Flat(ShapeForm form, const cv::Mat& depth) const {
    OutlineField field(camera_, mask_);
    field.AddDepthMap(depth, Eigen::Vector3d::Zero());
    core::TriangleMesh mesh = field.Extract(options_.resolution);
    // A lying object needs a flat face to rest on: a little is cut off below its centre of mass.
    const Eigen::Vector3d center = geometry::SolidMassProperties(mesh, 1.0).center_of_mass;
    const Eigen::Vector3d down = SupportDirection(mesh, center);
    const double height = core::Bounds(mesh).sizes().z(), reach = InflationReach(mesh, down);
    for (double ratio = options_.base_cut_ratio; ratio < 2.6 * options_.base_cut_ratio;
         ratio *= 1.5) {
      field.Cut(down, reach - ratio * height);
      mesh = field.Extract(options_.resolution);
      const Eigen::Vector3d now = geometry::SolidMassProperties(mesh, 1.0).center_of_mass;
      if (geometry::TippingAngle(mesh, now, down, 1e-3 * height) > options_.base_tilt_angle) break;
    }
    return Finish(form, std::move(mesh),
                  Eigen::Hyperplane<double, 3>(camera_.world_from_camera.linear().col(2),
                                               Eigen::Vector3d::Zero()));
  }

  InflatedShape Finish(ShapeForm form, core::TriangleMesh mesh,
                       const Eigen::Hyperplane<double, 3>& mirror) const {
    core::CheckCancelled();
    InflatedShape shape;
    shape.form = form;
    shape.mirror = mirror;
    shape.mesh = std::move(mesh);
    geometry::SimplifyOptions simplify;
    simplify.face_budget = options_.face_budget;
    if (static_cast<int>(shape.mesh.triangles.size()) > simplify.face_budget) {
      shape.mesh = geometry::Simplify(shape.mesh, simplify);
    }
    shape.silhouette_iou = SilhouetteIou(shape.mesh, camera_, matte_);
    return shape;
  }

  const Matte& matte_;
  const core::Camera& camera_;
  const CategoryPrior& prior_;
  const InflationOptions& options_;
  cv::Mat mask_;
};

}  // namespace

const char* Name(ShapeForm form) {
  constexpr const char* kNames[] = {"revolved upright", "revolved lying", "inflated"};
  return kNames[static_cast<int>(form)];
}

core::Camera PhotoCamera(const Matte& matte, double focal, double elevation) {
  core::Camera camera;
  camera.width = matte.alpha.width;
  camera.height = matte.alpha.height;
  camera.fx = camera.fy = focal;
  camera.cx = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
  const Eigen::Vector3d sight((0.5 * (matte.left + matte.right) - camera.cx) / focal,
                              (0.5 * (matte.top + matte.bottom) - camera.cy) / focal, 1.0);
  // The optical axis points lower than the line of sight where the object is above the image
  // centre.
  const double axis = elevation - std::atan(sight.y());
  const double c = std::cos(axis), s = std::sin(axis);
  Eigen::Matrix3d rotation;
  rotation.col(0) = Eigen::Vector3d(1, 0, 0);
  rotation.col(1) = Eigen::Vector3d(0, -s, -c);
  rotation.col(2) = Eigen::Vector3d(0, c, -s);
  camera.world_from_camera.linear() = rotation;
  camera.world_from_camera.translation() = -(rotation * sight.normalized());
  return camera;
}

double SilhouetteIou(const core::TriangleMesh& mesh, const core::Camera& camera,
                     const Matte& matte) {
  core::TexturedMesh textured;
  textured.mesh = mesh;
  render::Scene scene;
  scene.Add(&textured);
  scene.Commit();
  const render::ForwardBuffers buffers = render::RenderForward(scene, camera);
  double both = 0.0, either = 0.0;
  for (size_t i = 0; i < buffers.mask.size(); ++i) {
    const bool a = buffers.mask[i] > 0.5f, b = matte.alpha.pixels[i] > 127;
    both += a && b;
    either += a || b;
  }
  return either > 0.0 ? both / either : 0.0;
}

ElevationEstimate RefineElevation(const Matte& matte, double focal,
                                  const ElevationEstimate& estimate) {
  const cv::Mat mask = MaskOfMatte(matte);
  constexpr double kStep = 0.06;  // rad
  ElevationEstimate best = estimate;
  double best_score = -1e300;
  for (int i = -6; i <= 6; ++i) {
    const double elevation = estimate.elevation + kStep * i;
    if (elevation < 0.03 || elevation > 1.45) continue;
    const UprightBody body = FitUprightBody(mask, PhotoCamera(matte, focal, elevation));
    if (body.coverage <= 0.0) continue;
    const size_t third = std::max<size_t>(1, body.radius.size() / 3);
    const double widest =
        *std::max_element(body.radius.begin(), body.radius.begin() + static_cast<long>(third));
    const double foot = widest > 0.0 ? body.radius.front() / widest : 0.0;
    const double z = (elevation - estimate.elevation) / std::max(0.05, estimate.deviation);
    // One percent less silhouette coverage weighs as much as a base narrower by a sixth.
    const double score = -0.5 * z * z + 60.0 * body.coverage + 4.0 * foot;
    if (score > best_score) {
      best_score = score;
      best.elevation = elevation;
    }
  }
  best.deviation = std::min(estimate.deviation, 0.1);
  best.sentence = estimate.sentence + ", refined by its base to " +
                  std::to_string(std::lround(best.elevation * 180.0 / M_PI));
  return best;
}

std::optional<double> StraightWallFocal(const Matte& matte, double focal, double elevation) {
  constexpr double kMostTaper = 0.125, kLeastTaper = 0.01, kMostDeviation = 0.015;
  constexpr double kShortest = 0.6, kLongest = 8.0;  // over the assumed focal length
  constexpr int kHalvings = 7;
  const cv::Mat mask = MaskOfMatte(matte);
  const auto wall_at = [&](double factor) {
    const UprightBody body = FitUprightBody(mask, PhotoCamera(matte, factor * focal, elevation));
    return body.radius.size() < 12 ? WallLine{0.0, 1.0} : FitWallLine(body);
  };
  const WallLine wall = wall_at(1.0);
  if (wall.deviation > kMostDeviation || std::abs(wall.taper) > kMostTaper ||
      std::abs(wall.taper) < kLeastTaper) {
    return {};
  }
  // A longer focal length widens the top of what a camera sees from above.
  double inner = 1.0, outer = wall.taper < 0.0 ? kLongest : kShortest;
  const double outer_taper = wall_at(outer).taper;
  if (outer_taper * wall.taper > 0.0) {
    if (std::abs(outer_taper) > kLeastTaper) return {};
    return outer * focal;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(inner * outer);
    (wall_at(middle).taper * wall.taper > 0.0 ? inner : outer) = middle;
  }
  return std::sqrt(inner * outer) * focal;
}

InflatedShape InflateOutline(const Matte& matte, const core::Camera& camera,
                             const CategoryPrior& prior, const InflationOptions& options) {
  if (matte.right <= matte.left || matte.bottom <= matte.top) {
    throw core::Error("the matte is empty");
  }
  return Inflater(matte, camera, prior, options).Inflate();
}

}  // namespace simwright::asset_lift
