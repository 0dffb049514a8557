#include "geometry/voxel_solid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "geometry/surface_grid.h"

namespace simwright::geometry {
namespace {

constexpr int kMargin = 2;
constexpr double kBandCells = 2.0;

// Nodes that a walk from the grid's border reaches without crossing a triangle.
std::vector<std::uint8_t> ReachedFromBorder(const SurfaceGrid& grid) {
  std::vector<std::uint8_t> reached(grid.count(), 0);
  std::vector<std::size_t> front = {0};  // the margin is free, so one corner stands for all
  reached[0] = 1;
  const auto& size = grid.size();
  const auto& stride = grid.stride();
  while (!front.empty()) {
    const std::size_t node = front.back();
    front.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<int>(node / stride[axis] % static_cast<std::size_t>(size[axis]));
      for (const int step : {-1, 1}) {
        if (at + step < 0 || at + step >= size[axis]) continue;
        const std::size_t next = step > 0 ? node + stride[axis] : node - stride[axis];
        if (reached[next] || grid.Crossed(std::min(node, next), axis)) continue;
        reached[next] = 1;
        front.push_back(next);
      }
    }
  }
  return reached;
}

// Whether one of the 26 neighbours of an inner node lies on the other side of the surface.
bool BesideOtherSide(const std::vector<std::uint8_t>& reached, const SurfaceGrid& grid,
                     std::size_t node) {
  const auto& stride = grid.stride();
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const auto step = x * static_cast<std::ptrdiff_t>(stride[0]) +
                          y * static_cast<std::ptrdiff_t>(stride[1]) +
                          z * static_cast<std::ptrdiff_t>(stride[2]);
        if (reached[node + static_cast<std::size_t>(step)] != reached[node]) return true;
      }
    }
  }
  return false;
}

}  // namespace

VoxelSolid::VoxelSolid(const core::TriangleMesh& mesh, int resolution, double sheet_cells,
                       double growth_cells) {
  core::RequireValid(mesh, "voxel solid");
  if (resolution < 8 || resolution > 512) {
    throw core::Error("a voxel solid has 8 to 512 cells along its longest side");
  }
  const double longest = mesh.empty() ? 0.0 : core::Bounds(mesh).sizes().maxCoeff();
  if (!(longest > 0.0)) throw core::Error("a mesh without extent fills nothing");
  cell_ = longest / resolution;
  const SurfaceGrid grid(mesh, cell_, kBandCells * cell_, kMargin);
  const std::vector<std::uint8_t> reached = ReachedFromBorder(grid);
  origin_ = grid.origin();
  nx_ = grid.size()[0];
  ny_ = grid.size()[1];
  nz_ = grid.size()[2];
  occupancy_.resize(grid.count());
  for (int k = 0; k < nz_; ++k) {
    for (int j = 0; j < ny_; ++j) {
      for (int i = 0; i < nx_; ++i) {
        const std::size_t node = static_cast<std::size_t>(i) * grid.stride()[0] +
                                 static_cast<std::size_t>(j) * grid.stride()[1] +
                                 static_cast<std::size_t>(k) * grid.stride()[2];
        const double distance = std::min<double>(grid.Distance(node) / cell_, kBandCells);
        // Beside the other side the surface is a solid's, and its distance is right as it is. A
        // surface without one is a sheet outside, and buried inside.
        double outside = distance;
        if (distance < 0.5 * sheet_cells + 0.5 && !BesideOtherSide(reached, grid, node)) {
          outside = reached[node] ? distance - 0.5 * sheet_cells : -kBandCells;
        } else if (!reached[node]) {
          outside = -distance;
        }
        const double share = std::clamp(0.5 - outside + growth_cells, 0.0, 1.0);
        occupancy_[(static_cast<std::size_t>(k) * ny_ + j) * nx_ + i] =
            static_cast<std::uint8_t>(std::lround(255.0 * share));
      }
    }
  }
}

float VoxelSolid::At(int i, int j, int k) const {
  return occupancy_[(static_cast<std::size_t>(k) * ny_ + j) * nx_ + i];
}

float VoxelSolid::Occupancy(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = (point - origin_) / cell_;
  if (!(p.minCoeff() >= 0.0 && p.x() < nx_ - 1 && p.y() < ny_ - 1 && p.z() < nz_ - 1)) return 0.0f;
  const int i = static_cast<int>(p.x()), j = static_cast<int>(p.y()), k = static_cast<int>(p.z());
  const auto u = static_cast<float>(p.x() - i), v = static_cast<float>(p.y() - j),
             w = static_cast<float>(p.z() - k);
  const auto along = [u](float a, float b) { return a + u * (b - a); };
  const float c00 = along(At(i, j, k), At(i + 1, j, k));
  const float c10 = along(At(i, j + 1, k), At(i + 1, j + 1, k));
  const float c01 = along(At(i, j, k + 1), At(i + 1, j, k + 1));
  const float c11 = along(At(i, j + 1, k + 1), At(i + 1, j + 1, k + 1));
  const float near = c00 + v * (c10 - c00), far = c01 + v * (c11 - c01);
  return (near + w * (far - near)) / 255.0f;
}

double VoxelSolid::Volume() const {
  const double sum = std::accumulate(occupancy_.begin(), occupancy_.end(), 0.0);
  return sum / 255.0 * cell_ * cell_ * cell_;
}

}  // namespace simwright::geometry
