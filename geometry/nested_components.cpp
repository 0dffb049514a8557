#include "geometry/nested_components.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>

#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Returns a rotation that no mesh is aligned with: rays along its z axis hit edges only by chance.
Eigen::Matrix3d SkewRotation() {
  return Eigen::AngleAxisd(0.9371, Vector3d(0.3217, -0.7411, 0.5893).normalized())
      .toRotationMatrix();
}

// Returns the side of the line through the edge (i, j) on which a point lies, consistently for both
// triangles at the edge: a ray never slips between them, nor counts both.
bool LeftOf(int i, int j, const std::vector<Vector3d>& vertices, const Vector3d& point) {
  const Vector3d& a = vertices[std::min(i, j)];
  const Vector3d& b = vertices[std::max(i, j)];
  const bool left =
      (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x()) > 0.0;
  return i < j ? left : !left;
}

// A grid of points binned by x and y.
class ComponentGrid {
 public:
  explicit ComponentGrid(const std::vector<Vector3d>& points) {
    for (const Vector3d& p : points) box_.extend(p.head<2>());
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(points.size()))), 1, 512);
    start_.assign(static_cast<std::size_t>(side_) * side_ + 1, 0);
    for (const Vector3d& p : points) ++start_[CellAt(p.head<2>()) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<int> next = start_;
    order_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      order_[next[CellAt(points[i].head<2>())]++] = static_cast<int>(i);
    }
  }

  // Calls visit(point index) for all points in cells that overlap the box, and possibly more.
  template <typename Visit>
  void ForPointsIn(const Eigen::AlignedBox2d& box, const Visit& visit) const {
    if (!box.intersects(box_)) return;
    const std::array<int, 2> low = Cell(box.min());
    const std::array<int, 2> high = Cell(box.max());
    for (int y = low[1]; y <= high[1]; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * side_;
      for (int i = start_[row + low[0]]; i < start_[row + high[0] + 1]; ++i) visit(order_[i]);
    }
  }

 private:
  std::array<int, 2> Cell(const Vector2d& p) const {
    std::array<int, 2> cell;
    for (int k = 0; k < 2; ++k) {
      const double extent = std::max(box_.sizes()[k], 1e-300);
      const double at = (p[k] - box_.min()[k]) / extent * side_;
      cell[k] = static_cast<int>(std::clamp(at, 0.0, side_ - 1.0));
    }
    return cell;
  }
  std::size_t CellAt(const Vector2d& p) const {
    const std::array<int, 2> cell = Cell(p);
    return static_cast<std::size_t>(cell[1]) * side_ + cell[0];
  }

  Eigen::AlignedBox2d box_;
  int side_ = 1;
  std::vector<int> start_;
  std::vector<int> order_;
};

// Returns +1 if the ray upward from the point leaves through the triangle, -1 if it enters.
int Crossing(const Eigen::Vector3i& t, const std::vector<Vector3d>& vertices,
             const Vector3d& point) {
  const bool left = LeftOf(t[0], t[1], vertices, point);
  if (LeftOf(t[1], t[2], vertices, point) != left) return 0;
  if (LeftOf(t[2], t[0], vertices, point) != left) return 0;
  const Vector3d& a = vertices[t[0]];
  const Vector3d normal = (vertices[t[1]] - a).cross(vertices[t[2]] - a);
  // The plane's height above the point, times normal.z, whose sign is that of `left`.
  const double above = normal.dot(a - point);
  if (left) return above > 0.0 ? 1 : 0;
  return above < 0.0 ? -1 : 0;
}

}  // namespace

std::vector<int> EnclosingWindingNumbers(const core::TriangleMesh& mesh,
                                         const std::vector<int>& component, int count) {
  if (count <= 1) return std::vector<int>(count, 0);
  const Eigen::Matrix3d turn = SkewRotation();
  std::vector<Vector3d> vertices(mesh.vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = turn * mesh.vertices[v];
  std::vector<Vector3d> points(count, Vector3d::Zero());
  for (std::size_t t = component.size(); t-- > 0;) {
    points[component[t]] = vertices[mesh.triangles[t][0]];
  }
  const ComponentGrid grid(points);
  std::vector<std::atomic<int>> winding(count);
  constexpr std::size_t kBlock = 4096;
  const std::size_t faces = mesh.triangles.size();
  core::ParallelFor(static_cast<int>((faces + kBlock - 1) / kBlock), [&](int block) {
    core::CheckCancelled();
    for (std::size_t t = block * kBlock; t < std::min(faces, (block + 1) * kBlock); ++t) {
      const Eigen::Vector3i& corner = mesh.triangles[t];
      Eigen::AlignedBox2d box;
      for (int c = 0; c < 3; ++c) box.extend(vertices[corner[c]].head<2>());
      grid.ForPointsIn(box, [&](int inner) {
        if (inner != component[t]) winding[inner] += Crossing(corner, vertices, points[inner]);
      });
    }
  });
  return {winding.begin(), winding.end()};
}

std::vector<double> ComponentVolumes(const core::TriangleMesh& mesh,
                                     const std::vector<int>& component, int count) {
  std::vector<double> volumes(count, 0.0);
  if (mesh.empty()) return volumes;
  const Vector3d reference = mesh.vertices[mesh.triangles[0][0]];
  for (std::size_t t = 0; t < component.size(); ++t) {
    const Eigen::Vector3i& corner = mesh.triangles[t];
    const Vector3d a = mesh.vertices[corner[0]] - reference;
    const Vector3d b = mesh.vertices[corner[1]] - reference;
    const Vector3d c = mesh.vertices[corner[2]] - reference;
    volumes[component[t]] += a.dot(b.cross(c)) / 6.0;
  }
  return volumes;
}

void RemoveBuriedComponents(core::TriangleMesh* mesh) {
  int count = 0;
  const std::vector<int> component = EdgeComponents(*mesh, &count);
  const std::vector<int> winding = EnclosingWindingNumbers(*mesh, component, count);
  const std::vector<double> volumes = ComponentVolumes(*mesh, component, count);
  std::vector<Eigen::Vector3i> kept;
  for (std::size_t t = 0; t < component.size(); ++t) {
    const int c = component[t];
    if (winding[c] == (volumes[c] > 0.0 ? 0 : 1)) kept.push_back(mesh->triangles[t]);
  }
  mesh->triangles.swap(kept);
  *mesh = WithoutUnusedVertices(*mesh);
}

}  // namespace simwright::geometry
