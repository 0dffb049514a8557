#include "capture/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/surface_distance.h"
#include "geometry/voxel_solid.h"

namespace simwright::capture {
namespace {

constexpr double kGridMargin = 0.25;  // of the surface's diagonal

}  // namespace

DistanceGrid::DistanceGrid(const core::TriangleMesh& surface, int cells) {
  Eigen::AlignedBox3d box = core::Bounds(surface);
  grid_.cell = box.sizes().maxCoeff() / cells;
  const double margin = kGridMargin * box.diagonal().norm();
  box.min().array() -= margin;
  box.max().array() += margin;
  grid_.origin = box.min();
  grid_.nx = static_cast<int>(box.sizes().x() / grid_.cell) + 2;
  grid_.ny = static_cast<int>(box.sizes().y() / grid_.cell) + 2;
  grid_.nz = static_cast<int>(box.sizes().z() / grid_.cell) + 2;
  std::vector<Eigen::Vector3d> nodes;
  for (int k = 0; k < grid_.nz; ++k) {
    for (int j = 0; j < grid_.ny; ++j) {
      for (int i = 0; i < grid_.nx; ++i) {
        nodes.push_back(grid_.origin + grid_.cell * Eigen::Vector3d(i, j, k));
      }
    }
  }
  const std::vector<double> distances = geometry::DistancesToSurface(nodes, surface);
  const geometry::VoxelSolid solid(
      surface, geometry::VoxelSolidOptions{.resolution = cells, .sheet_cells = 0.0});
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool inside = solid.Occupancy(nodes[i]) > 0.5f;
    grid_.values.push_back(static_cast<float>(inside ? -distances[i] : distances[i]));
  }
}

double DistanceGrid::At(const Eigen::Vector3d& point, Eigen::Vector3d* gradient) const {
  const Eigen::Vector3d at = (point - grid_.origin) / grid_.cell;
  const Eigen::Vector3d most(grid_.nx - 1.001, grid_.ny - 1.001, grid_.nz - 1.001);
  const Eigen::Vector3d held = at.cwiseMax(0.0).cwiseMin(most);
  const int i = static_cast<int>(held.x()), j = static_cast<int>(held.y()),
            k = static_cast<int>(held.z());
  const double u = held.x() - i, v = held.y() - j, w = held.z() - k;
  const auto node = [&](int a, int b, int c) {
    return static_cast<double>(grid_.values[grid_.Index(i + a, j + b, k + c)]);
  };
  const double x00 = (1 - u) * node(0, 0, 0) + u * node(1, 0, 0);
  const double x10 = (1 - u) * node(0, 1, 0) + u * node(1, 1, 0);
  const double x01 = (1 - u) * node(0, 0, 1) + u * node(1, 0, 1);
  const double x11 = (1 - u) * node(0, 1, 1) + u * node(1, 1, 1);
  const double y0 = (1 - v) * x00 + v * x10, y1 = (1 - v) * x01 + v * x11;
  if (gradient != nullptr) {
    const double dx0 =
        (1 - v) * (node(1, 0, 0) - node(0, 0, 0)) + v * (node(1, 1, 0) - node(0, 1, 0));
    const double dx1 =
        (1 - v) * (node(1, 0, 1) - node(0, 0, 1)) + v * (node(1, 1, 1) - node(0, 1, 1));
    *gradient =
        Eigen::Vector3d((1 - w) * dx0 + w * dx1, (1 - w) * (x10 - x00) + w * (x11 - x01), y1 - y0) /
        grid_.cell;
  }
  return (1 - w) * y0 + w * y1 + grid_.cell * (at - held).norm();
}

}  // namespace simwright::capture
