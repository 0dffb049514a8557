#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "core/camera.h"
#include "geometry/isosurface.h"
#include "render/differentiable.h"

// Objects of known shape and their images, for the tests of the fits.
namespace simwright::asset_lift {

// Returns the zero isosurface of a function (negative inside) in a cube of half side `half` about
// the origin.
inline core::TriangleMesh SurfaceOf(const std::function<double(const Eigen::Vector3d&)>& field,
                                    double half, int cells) {
  geometry::ScalarGrid grid;
  grid.cell = 2.0 * half / cells;
  grid.origin.setConstant(-half);
  grid.nx = grid.ny = grid.nz = cells + 1;
  grid.values.resize(grid.Index(0, 0, grid.nz));
  for (int k = 0; k <= cells; ++k) {
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        grid.values[grid.Index(i, j, k)] =
            static_cast<float>(field(grid.origin + grid.cell * Eigen::Vector3d(i, j, k)));
      }
    }
  }
  return geometry::ExtractIsosurface(grid, 0.0f);
}

inline core::TriangleMesh Sphere(double radius) {
  return SurfaceOf([&](const Eigen::Vector3d& p) { return p.norm() - radius; }, 1.3 * radius, 24);
}

inline core::TriangleMesh BumpySphere() {
  return SurfaceOf(
      [](const Eigen::Vector3d& p) {
        const Eigen::Vector3d n = p.stableNormalized();
        return p.norm() - 0.1 - 0.012 * std::sin(5.0 * n.x()) * std::cos(4.0 * n.y());
      },
      0.13, 48);
}

// Two boxes without rotational symmetry.
inline core::TriangleMesh Hook() {
  const auto box = [](const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                      const Eigen::Vector3d& high) {
    return (low - p).cwiseMax(p - high).maxCoeff();
  };
  return SurfaceOf(
      [&](const Eigen::Vector3d& p) {
        return std::min(box(p, {-0.1, -0.03, -0.1}, {-0.02, 0.03, 0.1}),
                        box(p, {-0.1, -0.03, -0.1}, {0.1, 0.03, -0.04}));
      },
      0.13, 40);
}

// Returns images from all sides with depths; colours are a smooth function of position.
inline std::vector<ObservedView> ViewsOf(const core::TriangleMesh& mesh, int count, int size) {
  render::DifferentiableObject object;
  object.mesh = mesh;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    object.vertex_colors.push_back((0.5 + 0.3 * (40.0 * v).array().sin()).matrix().cast<float>());
  }
  render::DifferentiableOptions options;
  options.samples_per_side = 4;
  render::DifferentiableRenderer renderer({object}, options);
  std::vector<ObservedView> views;
  for (int i = 0; i < count; ++i) {
    ObservedView view;
    const double elevation = std::asin(-0.4 + 1.3 * (i + 0.5) / count);
    view.camera =
        core::OrbitCamera(Eigen::Vector3d::Zero(), 0.6, elevation, 2.4 * i, 0.5, size, size);
    const render::DifferentiableBuffers& picture = renderer.Render(view.camera, 50 + i);
    view.opacity = picture.mask;
    view.color = picture.color;
    view.depth = picture.depth;
    for (std::size_t p = 0; p < picture.mask.values.size(); ++p) {
      const float share = picture.mask.values[p];
      if (share < 0.999f) view.depth.values[p] = 0.0f;  // unknown at outlines
      for (std::size_t c = 3 * p; share > 0.0f && c < 3 * p + 3; ++c) view.color.values[c] /= share;
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace simwright::asset_lift
