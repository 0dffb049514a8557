#include "bench/asset_lift/fit_shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "asset_lift/multi_view/visual_hull.h"
#include "core/camera.h"
#include "geometry/isosurface.h"
#include "geometry/remesh.h"
#include "geometry/surface_distance.h"
#include "render/differentiable.h"

namespace simwright {
namespace {

using Distance = std::function<double(const Eigen::Vector3d&)>;

// Returns the surface where `inside` (negative inside, m) is 0, in the box of half side `half`.
core::TriangleMesh Surface(const Distance& inside, double half, int cells) {
  geometry::ScalarGrid grid;
  grid.cell = 2.0 * half / cells;
  grid.origin.setConstant(-half);
  grid.nx = grid.ny = grid.nz = cells + 1;
  grid.values.resize(grid.Index(0, 0, grid.nz));
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        grid.values[grid.Index(i, j, k)] =
            static_cast<float>(inside(grid.origin + grid.cell * Eigen::Vector3d(i, j, k)));
      }
    }
  }
  return geometry::ExtractIsosurface(grid, 0.0f);
}

double Ring(const Eigen::Vector3d& p, double radius, double thickness) {
  return std::hypot(std::hypot(p.x(), p.y()) - radius, p.z()) - thickness;
}

double Cylinder(const Eigen::Vector3d& p, double radius, double low, double high) {
  const double side = std::hypot(p.x(), p.y()) - radius;
  const double end = std::max(low - p.z(), p.z() - high);
  return std::min(std::max(side, end), 0.0) + std::hypot(std::max(side, 0.0), std::max(end, 0.0));
}

double Box(const Eigen::Vector3d& p, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d out = (low - p).cwiseMax(p - high);
  return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
}

double Mug(const Eigen::Vector3d& p) {
  const double body = std::max(Cylinder(p, 0.04, -0.05, 0.05), -Cylinder(p, 0.035, -0.043, 0.2));
  const Eigen::Vector3d turned(p.x() - 0.042, p.z(), p.y());
  const double handle = std::max(Ring(turned, 0.026, 0.006), -Cylinder(p, 0.0375, -1.0, 1.0));
  return std::min(body, handle);
}

double Chair(const Eigen::Vector3d& p) {
  double d = Box(p, {-0.22, -0.22, -0.02}, {0.22, 0.22, 0.03});
  for (const double x : {-0.19, 0.19}) {
    for (const double y : {-0.19, 0.19}) {
      d = std::min(d, Box(p, {x - 0.025, y - 0.025, -0.45}, {x + 0.025, y + 0.025, 0.0}));
    }
    d = std::min(d, Box(p, {x - 0.025, 0.165, 0.0}, {x + 0.025, 0.215, 0.45}));
  }
  return std::min(d, Box(p, {-0.2, 0.175, 0.2}, {0.2, 0.205, 0.42}));
}

double BumpySphere(const Eigen::Vector3d& p) {
  const Eigen::Vector3d n = p.stableNormalized();
  return p.norm() - 0.1 -
         0.01 * std::sin(5.0 * n.x()) * std::cos(4.0 * n.y()) * std::cos(4.5 * n.z() + 1.0);
}

// Returns a pattern with waves of about a fifth of the object, and baked light from above.
std::vector<Eigen::Vector3f> Pattern(const core::TriangleMesh& mesh) {
  const double wave = 2.0 * std::numbers::pi * 4.0 / core::Bounds(mesh).diagonal().norm();
  const std::vector<Eigen::Vector3d> normals = core::VertexNormals(mesh);
  std::vector<Eigen::Vector3f> colors;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = wave * mesh.vertices[i];
    const Eigen::Vector3d tint(0.5 + 0.3 * std::sin(p.x() + 0.5 * p.z()),
                               0.5 + 0.3 * std::sin(p.y() - 0.7 * p.x() + 1.0),
                               0.5 + 0.3 * std::sin(p.z() + 0.6 * p.y() + 2.0));
    const double light = 0.8 + 0.2 * normals[i].dot(Eigen::Vector3d(0.3, -0.4, 0.86));
    colors.push_back((light * tint).cast<float>());
  }
  return colors;
}

}  // namespace

std::vector<FitShape> FitShapes() {
  return {{"bumpy sphere", Surface(BumpySphere, 0.13, 96), {"sphere"}},
          {"torus",
           Surface([](const Eigen::Vector3d& p) { return Ring(p, 0.1, 0.035); }, 0.15, 96),
           {"wrap", "hull"}},
          {"mug", Surface(Mug, 0.08, 160), {"wrap", "hull", "carved"}},
          {"chair", Surface(Chair, 0.5, 160), {"wrap", "hull"}}};
}

std::vector<asset_lift::ObservedView> PatternedViews(const core::TriangleMesh& mesh, int count,
                                                     int size) {
  render::DifferentiableObject object;
  object.mesh = mesh;
  object.vertex_colors = Pattern(mesh);
  render::DifferentiableOptions options;
  options.samples_per_side = 8;
  render::DifferentiableRenderer renderer({object}, options);
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  constexpr double kFov = 0.6;
  const double distance = 0.54 * box.diagonal().norm() / std::sin(0.5 * kFov);
  // Uniform over the sphere from 25 deg below to 70 deg above, a golden angle apart.
  const auto elevation = [&](int i) { return std::asin(-0.42 + 1.36 * (i + 0.5) / count); };
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<asset_lift::ObservedView> views;
  for (int i = 0; i < count; ++i) {
    asset_lift::ObservedView view;
    view.camera =
        core::OrbitCamera(box.center(), distance, elevation(i), turn * i, kFov, size, size);
    const render::DifferentiableBuffers& picture = renderer.Render(view.camera, 100 + i);
    view.opacity = picture.mask;
    view.color = picture.color;
    for (std::size_t p = 0; p < picture.mask.values.size(); ++p) {
      const float share = picture.mask.values[p];
      for (std::size_t c = 3 * p; share > 0.0f && c < 3 * p + 3; ++c) view.color.values[c] /= share;
    }
    views.push_back(std::move(view));
  }
  return views;
}

core::TriangleMesh SphereAbout(const std::vector<asset_lift::ObservedView>& views) {
  const Eigen::AlignedBox3d box = asset_lift::HullBounds(views);
  const Eigen::Vector3d middle = box.center();
  const double radius = 0.45 * box.sizes().mean();
  geometry::ScalarGrid grid;
  const int cells = 24;
  grid.cell = 2.4 * radius / cells;
  grid.origin = middle.array() - 1.2 * radius;
  grid.nx = grid.ny = grid.nz = cells + 1;
  grid.values.resize(grid.Index(0, 0, grid.nz));
  for (int k = 0; k <= cells; ++k) {
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        const Eigen::Vector3d p = grid.origin + grid.cell * Eigen::Vector3d(i, j, k);
        grid.values[grid.Index(i, j, k)] = static_cast<float>((p - middle).norm() - radius);
      }
    }
  }
  geometry::RemeshOptions remesh;
  remesh.edge_length = 0.15 * radius;
  return geometry::RemeshIsotropic(geometry::ExtractIsosurface(grid, 0.0f), remesh);
}

double Chamfer(const core::TriangleMesh& one, const core::TriangleMesh& other) {
  const auto mean = [](const core::TriangleMesh& from, const core::TriangleMesh& to) {
    const std::vector<double> d =
        geometry::DistancesToSurface(geometry::SampleSurface(from, 20000, 7), to);
    return std::accumulate(d.begin(), d.end(), 0.0) / static_cast<double>(d.size());
  };
  return 0.5 * (mean(one, other) + mean(other, one));
}

}  // namespace simwright
