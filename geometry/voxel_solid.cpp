#include "geometry/voxel_solid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "geometry/surface_grid.h"

namespace simwright::geometry {
namespace {

constexpr int kVoxelMargin = 2;
constexpr double kBandCells = 2.0;

// A flood fill over the grid's nodes along edges that no triangle crosses.
class FloodFill {
 public:
  // `floor` is the lowest layer of nodes that is entered, or 0.
  FloodFill(const SurfaceGrid& grid, int floor)
      : grid_(grid), floor_(floor), reached_(grid.count(), 0) {}

  // Starts from the top corner, which the margin keeps free, and passes nodes farther than `gap`
  // (cells) from the surface; then continues from all of them to the surface, and as far into
  // narrower gaps.
  void Run(double gap) {
    const std::size_t start = grid_.count() - 1;
    reached_[start] = 1;
    std::vector<std::size_t> front = {start}, shore;
    while (!front.empty()) {
      const std::size_t node = front.back();
      front.pop_back();
      bool inner = true;
      ForNeighbours(node, [&](std::size_t next) {
        if (grid_.Distance(next) < gap * grid_.cell()) {
          inner = false;
          return;
        }
        reached_[next] = 1;
        front.push_back(next);
      });
      if (!inner) shore.push_back(node);
    }
    // A path of length `gap` takes up to sqrt(3) times as many steps along the axes.
    for (int step = 0; step < static_cast<int>(std::ceil(std::sqrt(3.0) * gap)); ++step) {
      std::vector<std::size_t> next_shore;
      for (const std::size_t node : shore) {
        ForNeighbours(node, [&](std::size_t next) {
          reached_[next] = 1;
          next_shore.push_back(next);
        });
      }
      shore = std::move(next_shore);
    }
    const std::size_t below = static_cast<std::size_t>(floor_) * grid_.stride()[2];
    std::fill(reached_.begin(), reached_.begin() + static_cast<std::ptrdiff_t>(below), 1);
  }

  const std::vector<std::uint8_t>& reached() const { return reached_; }

 private:
  // Calls visit for the neighbours that are not reached yet.
  template <typename Visit>
  void ForNeighbours(std::size_t node, const Visit& visit) const {
    const auto& size = grid_.size();
    const auto& stride = grid_.stride();
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<int>(node / stride[axis] % static_cast<std::size_t>(size[axis]));
      const int lowest = axis == 2 ? floor_ : 0;
      for (const int step : {-1, 1}) {
        if (at + step < lowest || at + step >= size[axis]) continue;
        const std::size_t next = step > 0 ? node + stride[axis] : node - stride[axis];
        if (!reached_[next] && !grid_.Crossed(std::min(node, next), axis)) visit(next);
      }
    }
  }

  const SurfaceGrid& grid_;
  int floor_;
  std::vector<std::uint8_t> reached_;
};

// Returns true if one of the 26 neighbours of an inner node is on the other side of the surface.
bool HasNeighbourAcrossSurface(const std::vector<std::uint8_t>& reached, const SurfaceGrid& grid,
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

bool VoxelSolidOptions::IsValid(std::string* error) const {
  const char* fault = nullptr;
  if (resolution < 8 || resolution > 512) {
    fault = "a voxel solid needs 8 to 512 cells along its longest side";
  }
  if (!(sheet_cells >= 0.0) || !(growth_cells >= 0.0 && growth_cells <= 1.0)) {
    fault = "sheet thickness must be at least 0 and growth in [0, 1] cells";
  }
  if (!(gap_cells >= 0.0 && gap_cells <= 16.0)) fault = "the gap must be 0 to 16 cells";
  if (fault != nullptr && error != nullptr) *error = fault;
  return fault == nullptr;
}

VoxelSolid::VoxelSolid(const core::TriangleMesh& mesh, const VoxelSolidOptions& options) {
  core::RequireValid(mesh, "voxel solid");
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error);
  const double longest = mesh.empty() ? 0.0 : core::Bounds(mesh).sizes().maxCoeff();
  if (!(longest > 0.0)) throw core::Error("a mesh without extent fills nothing");
  cell_ = longest / options.resolution;
  const double band = std::max(kBandCells, options.gap_cells + 0.5);
  const int margin = kVoxelMargin + static_cast<int>(std::ceil(options.gap_cells));
  const SurfaceGrid grid(mesh, cell_, band * cell_, margin);
  const double bottom = core::Bounds(mesh).min().z() - grid.origin().z();
  // The first layer of nodes that is not below the mesh.
  FloodFill fill(grid, options.on_floor ? static_cast<int>(std::ceil(bottom / cell_ - 1e-6)) : 0);
  fill.Run(options.gap_cells);
  const std::vector<std::uint8_t>& reached = fill.reached();
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
        // With the other side adjacent, the surface bounds a solid, and its distance is used as is.
        // Otherwise it is a sheet next to an outside node, or buried next to an inside node.
        double outside = distance;
        if (distance < 0.5 * options.sheet_cells + 0.5 &&
            !HasNeighbourAcrossSurface(reached, grid, node)) {
          outside = reached[node] ? distance - 0.5 * options.sheet_cells : -kBandCells;
        } else if (!reached[node]) {
          outside = -distance;
        }
        const double share = std::clamp(0.5 - outside + options.growth_cells, 0.0, 1.0);
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
