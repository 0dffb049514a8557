#include "library/box_union.h"

#include <algorithm>
#include <array>
#include <map>

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kSame = 1e-9;  // m
constexpr int kEmpty = -1;

// The cells of space cut by the planes of all faces: a cell lies in a plank entirely or not at all.
class CellGrid {
 public:
  explicit CellGrid(const std::vector<FurnitureBox>& planks) : planks_(planks) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double>& cuts = cuts_[static_cast<size_t>(axis)];
      for (const FurnitureBox& plank : planks) {
        cuts.push_back(plank.box.min()[axis]);
        cuts.push_back(plank.box.max()[axis]);
      }
      std::sort(cuts.begin(), cuts.end());
      const auto same = [](double a, double b) { return b - a < kSame; };
      cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
    }
  }

  int Cells(int axis) const {
    return static_cast<int>(cuts_[static_cast<size_t>(axis)].size()) - 1;
  }

  Eigen::Vector3d Corner(const Eigen::Vector3i& at) const {
    return {cuts_[0][static_cast<size_t>(at.x())], cuts_[1][static_cast<size_t>(at.y())],
            cuts_[2][static_cast<size_t>(at.z())]};
  }

  // Returns the look of the first plank that fills the cell; kEmpty outside all planks.
  int LookAt(const Eigen::Vector3i& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= Cells(axis)) return kEmpty;
    }
    const Eigen::Vector3d middle = 0.5 * (Corner(cell) + Corner(cell + Eigen::Vector3i::Ones()));
    for (const FurnitureBox& plank : planks_) {
      if (plank.box.contains(middle)) return plank.look;
    }
    return kEmpty;
  }

 private:
  const std::vector<FurnitureBox>& planks_;
  std::array<std::vector<double>, 3> cuts_;
};

// Collects faces of cells; shared corners become one vertex.
class SurfaceOfCells {
 public:
  SurfaceOfCells(const CellGrid& grid, core::TexturedMesh* mesh) : grid_(grid), mesh_(mesh) {}

  // Adds the cell's face perpendicular to `axis`, above or below.
  void AddFace(const Eigen::Vector3i& cell, int axis, bool above, int look) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 4> corners;
    for (int k = 0; k < 4; ++k) {  // about the axis, counter-clockwise from above
      Eigen::Vector3i at = cell;
      at[axis] += above;
      at[u] += k == 1 || k == 2;
      at[v] += k >= 2;
      corners[static_cast<size_t>(k)] = Index(at);
    }
    if (!above) std::reverse(corners.begin(), corners.end());
    mesh_->mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    mesh_->mesh.triangles.push_back({corners[0], corners[2], corners[3]});
    mesh_->triangle_material.insert(mesh_->triangle_material.end(), 2, look);
  }

 private:
  int Index(const Eigen::Vector3i& at) {
    const auto [entry, fresh] = index_.emplace(std::array{at.x(), at.y(), at.z()},
                                               static_cast<int>(mesh_->mesh.vertices.size()));
    if (fresh) mesh_->mesh.vertices.push_back(grid_.Corner(at));
    return entry->second;
  }

  const CellGrid& grid_;
  core::TexturedMesh* mesh_;
  std::map<std::array<int, 3>, int> index_;
};

}  // namespace

core::TexturedMesh BoxUnion(const std::vector<FurnitureBox>& planks,
                            const std::vector<core::Material>& looks) {
  core::TexturedMesh mesh;
  mesh.materials = looks;
  const CellGrid grid(planks);
  SurfaceOfCells surface(grid, &mesh);
  for (int x = 0; x < grid.Cells(0); ++x) {
    for (int y = 0; y < grid.Cells(1); ++y) {
      for (int z = 0; z < grid.Cells(2); ++z) {
        const Eigen::Vector3i cell(x, y, z);
        const int look = grid.LookAt(cell);
        if (look == kEmpty) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
          if (grid.LookAt(cell + step) == kEmpty) surface.AddFace(cell, axis, true, look);
          if (grid.LookAt(cell - step) == kEmpty) surface.AddFace(cell, axis, false, look);
        }
      }
    }
  }
  return mesh;
}

std::vector<core::TriangleMesh> FurnitureBoxParts(const std::vector<FurnitureBox>& planks) {
  std::vector<core::TriangleMesh> parts;
  for (const FurnitureBox& plank : planks) {
    parts.push_back(Box(plank.box.min(), plank.box.max(), 0.0));
  }
  return parts;
}

}  // namespace simwright::library
