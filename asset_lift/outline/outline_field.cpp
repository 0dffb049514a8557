#include "asset_lift/outline/outline_field.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/camera/depth_map.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {
namespace {

// Interpolates bilinearly at an image point; the lookup is clamped at the frame and falls off
// beyond it.
double Lookup(const cv::Mat& map, double px, double py) {
  const double x = std::clamp(px - 0.5, 0.0, map.cols - 1.001);
  const double y = std::clamp(py - 0.5, 0.0, map.rows - 1.001);
  const double outside = std::hypot(px - 0.5 - x, py - 0.5 - y);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  const double value =
      (1 - fy) * ((1 - fx) * map.at<float>(y0, x0) + fx * map.at<float>(y0, x0 + 1)) +
      fy * ((1 - fx) * map.at<float>(y0 + 1, x0) + fx * map.at<float>(y0 + 1, x0 + 1));
  return outside > 1.0 ? std::min(value, 0.0) - 4.0 * outside : value;
}

}  // namespace

OutlineField::OutlineField(const core::Camera& camera, const cv::Mat& mask)
    : camera_(camera), edge_distance_(SignedEdgeDistance(mask)) {}

void OutlineField::AddUprightBody(const UprightBody& body) {
  bodies_.push_back([body](const Eigen::Vector3d& p) {
    const double radial = std::hypot(p.x() - body.axis_x, p.y() - body.axis_y);
    const double z = std::clamp(p.z(), body.bottom, body.top());
    const double side = radial - body.RadiusAt(z);
    const double end = std::max(body.bottom - p.z(), p.z() - body.top());
    return std::max(side, end);
  });
  const double r = body.MaxRadius();
  box_.extend(Eigen::Vector3d(body.axis_x - r, body.axis_y - r, body.bottom));
  box_.extend(Eigen::Vector3d(body.axis_x + r, body.axis_y + r, body.top()));
}

void OutlineField::HollowUprightBody(const UprightBody& body, double wall) {
  // The inner wall is parallel to the outer wall: it takes the minimum radius within a wall's
  // height, so that slanted walls stay as thick as upright ones.
  std::vector<double> inner(body.radius.size());
  const int reach = static_cast<int>(std::ceil(wall / body.step));
  for (int i = 0; i < static_cast<int>(inner.size()); ++i) {
    double least = body.radius[static_cast<size_t>(i)];
    for (int j = std::max(0, i - reach); j <= i; ++j) {
      least = std::min(least, body.radius[static_cast<size_t>(j)]);
    }
    inner[static_cast<size_t>(i)] = least - wall;
  }
  UprightBody cavity = body;
  cavity.radius = inner;
  const double floor = body.bottom + wall, rim = body.top();
  hollows_.push_back([cavity, floor, rim](const Eigen::Vector3d& p) {
    const double radial = std::hypot(p.x() - cavity.axis_x, p.y() - cavity.axis_y);
    const double side = radial - cavity.RadiusAt(std::clamp(p.z(), cavity.bottom, rim));
    // The hollow is unbounded above.
    return std::max(side, floor - p.z());
  });
}

void OutlineField::AddDepthMap(const cv::Mat& squared_depth, const Eigen::Vector3d& anchor) {
  const Eigen::Isometry3d camera_from_world = camera_.world_from_camera.inverse();
  const double depth = (camera_from_world * anchor).z();
  const double metres = depth / camera_.fy;  // metres per pixel at that depth
  const core::Camera camera = camera_;
  double deepest = 0.0;
  cv::minMaxLoc(squared_depth, nullptr, &deepest);
  const double half = metres * std::sqrt(std::max(1.0, deepest));
  bodies_.push_back(
      [camera, squared_depth, camera_from_world, depth, metres, half](const Eigen::Vector3d& p) {
        const Eigen::Vector3d local = camera_from_world * p;
        if (local.z() <= 1e-6) return half;
        const double u = Lookup(squared_depth, camera.fx * local.x() / local.z() + camera.cx,
                                camera.fy * local.y() / local.z() + camera.cy) *
                         metres * metres;
        const double d = local.z() - depth;
        // (d^2 - u) over its slope approximates a distance.
        return (d * d - u) / (2.0 * std::max(0.15 * half, std::sqrt(std::max(0.0, u))));
      });
  for (int y = 0; y < squared_depth.rows; ++y) {
    for (int x = 0; x < squared_depth.cols; ++x) {
      if (squared_depth.at<float>(y, x) <= 0.0f) continue;
      for (const double side : {-half, half}) {
        box_.extend(camera_.position() + (depth + side) * camera_.Ray({x + 0.5, y + 0.5}));
      }
    }
  }
}

double OutlineField::Value(const Eigen::Vector3d& point) const {
  double value = bodies_[0](point);
  for (const auto& hollow : hollows_) value = std::max(value, -hollow(point));
  for (size_t i = 1; i < bodies_.size(); ++i) value = std::min(value, bodies_[i](point));
  // A handle must not grow into the hollow of its vessel.
  if (bodies_.size() > 1) {
    for (const auto& hollow : hollows_) value = std::max(value, -hollow(point));
  }
  const Eigen::Vector3d pixel = camera_.Project(point);
  if (pixel.z() <= 0.0) return std::abs(value);
  const double cone = -Lookup(edge_distance_, pixel.x(), pixel.y()) * pixel.z() / camera_.fy;
  return std::max({value, cone, cut_direction_.dot(point) - cut_reach_});
}

core::TriangleMesh OutlineField::Extract(int resolution) const {
  if (bodies_.empty() || box_.isEmpty()) throw core::Error("nothing to inflate in the outline");
  geometry::ScalarGrid grid;
  grid.cell = box_.sizes().maxCoeff() / resolution;
  grid.origin = box_.min() - Eigen::Vector3d::Constant(2.5 * grid.cell);
  const Eigen::Vector3i nodes = (box_.sizes() / grid.cell).array().ceil().cast<int>() + 6;
  grid.nx = nodes.x();
  grid.ny = nodes.y();
  grid.nz = nodes.z();
  grid.values.resize(static_cast<size_t>(grid.nx) * grid.ny * grid.nz);
  core::ParallelFor(grid.nz, [&](int k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        grid.values[grid.Index(i, j, k)] =
            static_cast<float>(Value(grid.origin + grid.cell * Eigen::Vector3d(i, j, k)));
      }
    }
  });
  core::TriangleMesh mesh = geometry::ExtractIsosurface(grid, 0.0f);
  if (mesh.triangles.empty()) throw core::Error("nothing to inflate in the outline");
  return mesh;
}

}  // namespace simwright::asset_lift
