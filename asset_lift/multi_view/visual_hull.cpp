#include "asset_lift/multi_view/visual_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "asset_lift/multi_view/space_carving.h"
#include "asset_lift/multi_view/view_consistency.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/weld.h"

namespace simwright::asset_lift {
namespace {

void RequireImage(const core::FloatImage& image, const core::Camera& camera, int channels,
                  const std::string& where, const char* what) {
  if (image.width != camera.width || image.height != camera.height || image.channels != channels ||
      image.values.size() != static_cast<std::size_t>(camera.width) * camera.height * channels) {
    throw core::Error(std::string("the ") + what + " has another size than the camera", where);
  }
  for (const float v : image.values) {
    if (!std::isfinite(v)) throw core::Error(std::string("not finite: the ") + what, where);
  }
}

// Returns the least-squares intersection of the rays through the masks' centres.
Eigen::Vector3d RayIntersection(const std::vector<ObservedView>& views) {
  Eigen::Matrix3d sum = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const ObservedView& view : views) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double mass = 0.0;
    for (int y = 0; y < view.camera.height; ++y) {
      for (int x = 0; x < view.camera.width; ++x) {
        const double w = *view.opacity.At(x, y);
        middle += w * Eigen::Vector2d(x + 0.5, y + 0.5);
        mass += w;
      }
    }
    const Eigen::Vector3d ray = view.camera.Ray(middle / mass).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    sum += across;
    right += across * view.camera.position();
  }
  return sum.ldlt().solve(right);
}

// Returns the mask's greatest distance from the projection of `point`, at the point's depth, m.
double HullReach(const ObservedView& view, const Eigen::Vector3d& point) {
  const Eigen::Vector3d at = view.camera.Project(point);
  double most = 0.0;
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      if (*view.opacity.At(x, y) < 0.5f) continue;
      most = std::max(most, std::hypot((x + 0.5 - at.x()) / view.camera.fx,
                                       (y + 0.5 - at.y()) / view.camera.fy));
    }
  }
  return most * std::abs(at.z());
}

Eigen::AlignedBox3d InsideBounds(const geometry::ScalarGrid& field) {
  Eigen::AlignedBox3d box;
  for (int k = 0; k < field.nz; ++k) {
    for (int j = 0; j < field.ny; ++j) {
      for (int i = 0; i < field.nx; ++i) {
        if (field.values[field.Index(i, j, k)] < 0.5f * static_cast<float>(field.cell)) {
          box.extend(field.origin + field.cell * Eigen::Vector3d(i, j, k));
        }
      }
    }
  }
  if (!box.isEmpty()) {
    box.min().array() -= 1.5 * field.cell;
    box.max().array() += 1.5 * field.cell;
  }
  return box;
}

[[noreturn]] void ThrowNothingLeft(const std::vector<ObservedView>& views) {
  std::string which;
  for (const int i : CheckViewConsistency(views).contradicting) which += " " + std::to_string(i);
  throw core::Error("no point lies inside all the masks", "visual hull",
                    which.empty() ? "the cameras contradict each other or the grid is too coarse"
                                  : "these views contradict the others:" + which);
}

}  // namespace

core::TriangleMesh LargeComponents(const core::TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> part = geometry::EdgeComponents(mesh, &count);
  std::vector<double> volume(count, 0.0);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    volume[part[f]] +=
        mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
  }
  const double least = 0.01 * *std::max_element(volume.begin(), volume.end());
  core::TriangleMesh kept;
  kept.vertices = mesh.vertices;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (volume[part[f]] >= least) kept.triangles.push_back(mesh.triangles[f]);
  }
  return geometry::WithoutUnusedVertices(kept);
}

bool VisualHullOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (cells < 8 || cells > 512) return fail("cells must be 8 to 512");
  if (!(color_tolerance >= 0.0)) return fail("color_tolerance must not be negative");
  return true;
}

void RequireValid(const std::vector<ObservedView>& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ObservedView& view = views[i];
    const core::Camera& camera = view.camera;
    const std::string where = "view " + std::to_string(i);
    const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                        std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                        camera.world_from_camera.matrix().allFinite();
    if (camera.width < 2 || camera.height < 2 || !finite || !(camera.fx > 0.0) ||
        !(camera.fy > 0.0)) {
      throw core::Error("its camera needs pixels, focal lengths and finite values", where);
    }
    RequireImage(view.opacity, camera, 1, where, "mask");
    if (!view.color.empty()) RequireImage(view.color, camera, 3, where, "colour");
    if (!view.depth.empty()) RequireImage(view.depth, camera, 1, where, "depth");
    if (std::none_of(view.opacity.values.begin(), view.opacity.values.end(),
                     [](float v) { return v >= 0.5f; })) {
      throw core::Error("its mask is empty", where, "remove the view");
    }
  }
}

SilhouetteCone::SilhouetteCone(const ObservedView& view)
    : camera_(view.camera),
      camera_from_world_(view.camera.world_from_camera.inverse()),
      distance_(MaskDistance(view.opacity)),
      depth_(view.depth) {}

double SilhouetteCone::At(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = camera_from_world_ * point;
  if (!(p.z() > 0.0)) return std::abs(p.z()) + 1e-6;
  const double x = camera_.fx * p.x() / p.z() + camera_.cx - 0.5;
  const double y = camera_.fy * p.y() / p.z() + camera_.cy - 0.5;
  const double inner_x = std::clamp(x, 0.0, camera_.width - 1.0);
  const double inner_y = std::clamp(y, 0.0, camera_.height - 1.0);
  const double beyond = std::hypot(x - inner_x, y - inner_y);
  const double pixels = Bilinear(inner_x, inner_y);
  const double metres = p.z() / std::max(camera_.fx, camera_.fy);
  if (beyond > 0.5) {
    return pixels < 0.0 ? std::numeric_limits<double>::lowest() : (pixels + beyond) * metres;
  }
  return std::max(pixels * metres, InFront(x, y, p.z()));
}

double SilhouetteCone::Bilinear(double x, double y) const {
  const int x0 = std::min(static_cast<int>(x), camera_.width - 2);
  const int y0 = std::min(static_cast<int>(y), camera_.height - 2);
  const double fx = x - x0, fy = y - y0;
  return (1.0 - fy) * ((1.0 - fx) * *distance_.At(x0, y0) + fx * *distance_.At(x0 + 1, y0)) +
         fy * ((1.0 - fx) * *distance_.At(x0, y0 + 1) + fx * *distance_.At(x0 + 1, y0 + 1));
}

double SilhouetteCone::InFront(double x, double y, double z) const {
  if (depth_.empty()) return std::numeric_limits<double>::lowest();
  const float depth =
      *depth_.At(std::clamp(static_cast<int>(std::lround(x)), 0, camera_.width - 1),
                 std::clamp(static_cast<int>(std::lround(y)), 0, camera_.height - 1));
  return depth > 0.0f ? depth - z : std::numeric_limits<double>::lowest();
}

core::FloatImage MaskDistance(const core::FloatImage& opacity) {
  cv::Mat inside(opacity.height, opacity.width, CV_8U), outside;
  for (int y = 0; y < opacity.height; ++y) {
    for (int x = 0; x < opacity.width; ++x) {
      inside.at<std::uint8_t>(y, x) = *opacity.At(x, y) >= 0.5f ? 255 : 0;
    }
  }
  cv::bitwise_not(inside, outside);
  cv::Mat to_outside, to_inside;
  cv::distanceTransform(inside, to_outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(outside, to_inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // Without any pixel of the other kind OpenCV returns a huge number.
  const float most = static_cast<float>(opacity.width + opacity.height);
  core::FloatImage distance(opacity.width, opacity.height, 1);
  for (int y = 0; y < opacity.height; ++y) {
    for (int x = 0; x < opacity.width; ++x) {
      const float share = *opacity.At(x, y);
      // The outline runs between pixel centres, through partly covered pixels.
      float d = share >= 0.5f ? 0.5f - std::min(to_outside.at<float>(y, x), most)
                              : std::min(to_inside.at<float>(y, x), most) - 0.5f;
      if (share > 0.02f && share < 0.98f && std::abs(d) < 1.0f) d = 0.5f - share;
      *distance.At(x, y) = d;
    }
  }
  return distance;
}

geometry::ScalarGrid VisualHullField(const std::vector<ObservedView>& views,
                                     const Eigen::AlignedBox3d& box, int cells) {
  geometry::ScalarGrid field;
  field.cell = box.sizes().maxCoeff() / cells;
  field.origin = box.min();
  const auto nodes = [&](int axis) {
    return std::max(2, static_cast<int>(std::ceil(box.sizes()[axis] / field.cell)) + 1);
  };
  field.nx = nodes(0);
  field.ny = nodes(1);
  field.nz = nodes(2);
  field.values.resize(field.Index(0, 0, field.nz));
  std::vector<SilhouetteCone> cones;
  for (const ObservedView& view : views) cones.emplace_back(view);
  core::ParallelFor(field.nz, [&](int k) {
    core::CheckCancelled();
    for (int j = 0; j < field.ny; ++j) {
      for (int i = 0; i < field.nx; ++i) {
        const Eigen::Vector3d p = field.origin + field.cell * Eigen::Vector3d(i, j, k);
        double farthest = -box.diagonal().norm();
        for (const SilhouetteCone& cone : cones) farthest = std::max(farthest, cone.At(p));
        field.values[field.Index(i, j, k)] = static_cast<float>(farthest);
      }
    }
  });
  return field;
}

Eigen::AlignedBox3d MaskBounds(const std::vector<ObservedView>& views) {
  const Eigen::Vector3d middle = RayIntersection(views);
  double reach = 0.0;
  for (const ObservedView& view : views) reach = std::max(reach, HullReach(view, middle));
  reach *= 1.3;
  return Eigen::AlignedBox3d(Eigen::Vector3d(middle.array() - reach),
                             Eigen::Vector3d(middle.array() + reach));
}

Eigen::AlignedBox3d HullBounds(const std::vector<ObservedView>& views) {
  RequireValid(views);
  if (views.size() < 2) throw core::Error("a visual hull needs two views at least");
  Eigen::AlignedBox3d box = MaskBounds(views);
  for (int round = 0; round < 2; ++round) {
    const Eigen::AlignedBox3d inside = InsideBounds(VisualHullField(views, box, 40));
    if (inside.isEmpty()) ThrowNothingLeft(views);
    box = inside;
  }
  return box;
}

core::TriangleMesh VisualHull(const std::vector<ObservedView>& views,
                              const VisualHullOptions& options, core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "visual hull");
  RequireValid(views);
  if (views.size() < 2) throw core::Error("a visual hull needs two views at least");
  const Eigen::AlignedBox3d box = options.bounds.isEmpty() ? HullBounds(views) : options.bounds;
  geometry::ScalarGrid field = VisualHullField(views, box, options.cells);
  if (options.color_tolerance > 0.0) {
    CarveByColor(views, options.color_tolerance, &field, progress);
  }
  const core::TriangleMesh hull = geometry::ExtractIsosurface(field, 0.0f);
  if (hull.empty()) ThrowNothingLeft(views);
  return LargeComponents(hull);
}

}  // namespace simwright::asset_lift
