#include "capture/hull_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "geometry/surface_distance.h"
#include "geometry/voxel_solid.h"

namespace simwright::capture {
namespace {

geometry::ScalarGrid EmptyField(const core::TriangleMesh& hull, int cells) {
  const Eigen::AlignedBox3d box = core::Bounds(hull);
  geometry::ScalarGrid field;
  field.cell = box.sizes().maxCoeff() / cells;
  field.origin = box.min().array() - 2.0 * field.cell;
  const auto nodes = [&](int axis) {
    return static_cast<int>(std::ceil(box.sizes()[axis] / field.cell)) + 5;
  };
  field.nx = nodes(0);
  field.ny = nodes(1);
  field.nz = nodes(2);
  return field;
}

// Marks the nodes within `reach` (m) of the triangles' boxes.
std::vector<std::uint8_t> NearNodes(const core::TriangleMesh& hull,
                                    const geometry::ScalarGrid& field, double reach) {
  std::vector<std::uint8_t> near(field.Index(0, 0, field.nz), 0);
  for (const Eigen::Vector3i& t : hull.triangles) {
    Eigen::AlignedBox3d box;
    for (int c = 0; c < 3; ++c) box.extend(hull.vertices[static_cast<std::size_t>(t[c])]);
    const Eigen::Vector3d low = (box.min() - field.origin).array() - reach;
    const Eigen::Vector3d high = (box.max() - field.origin).array() + reach;
    const auto first = [&](int a) { return std::max(0, static_cast<int>(low[a] / field.cell)); };
    const auto last = [&](int a, int n) {
      return std::min(n - 1, static_cast<int>(high[a] / field.cell) + 1);
    };
    for (int k = first(2); k <= last(2, field.nz); ++k) {
      for (int j = first(1); j <= last(1, field.ny); ++j) {
        const auto row = near.begin() + static_cast<std::ptrdiff_t>(field.Index(0, j, k));
        std::fill(row + first(0), row + last(0, field.nx) + 1, std::uint8_t{1});
      }
    }
  }
  return near;
}

}  // namespace

geometry::ScalarGrid HullField(const core::TriangleMesh& hull, const HullFieldOptions& options) {
  if (hull.empty()) throw core::Error("the hull is empty", "hull field");
  geometry::ScalarGrid field = EmptyField(hull, options.cells);
  const double band = options.band_cells * field.cell;
  const std::vector<std::uint8_t> near = NearNodes(hull, field, band + field.cell);
  const geometry::VoxelSolid solid(hull, {.resolution = options.cells, .sheet_cells = 0.0});
  std::vector<Eigen::Vector3d> points;
  std::vector<std::size_t> at;
  field.values.resize(near.size());
  for (int k = 0; k < field.nz; ++k) {
    for (int j = 0; j < field.ny; ++j) {
      for (int i = 0; i < field.nx; ++i) {
        const std::size_t n = field.Index(i, j, k);
        const Eigen::Vector3d point = field.origin + field.cell * Eigen::Vector3d(i, j, k);
        field.values[n] = static_cast<float>(solid.Occupancy(point) > 0.5f ? -band : band);
        if (near[n] == 0) continue;
        points.push_back(point);
        at.push_back(n);
      }
    }
  }
  const std::vector<double> distances = geometry::DistancesToSurface(points, hull);
  for (std::size_t p = 0; p < at.size(); ++p) {
    float& value = field.values[at[p]];
    value = std::copysign(static_cast<float>(std::min(distances[p], band)), value);
  }
  return field;
}

}  // namespace simwright::capture
