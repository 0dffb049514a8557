#include "geometry/surface_wrap.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "geometry/isosurface.h"
#include "geometry/nested_components.h"
#include "geometry/surface_grid.h"
#include "geometry/triangle_tree.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kWrapMargin = 3;
// The largest distance in cells between a visible point and the outside node that reaches it: in a
// corner of three walls the nearest node can be sqrt(3) away.
constexpr double kReached = 1.75;
constexpr int kProbes = 100;          // rays around a hidden point
constexpr int kProbeBudget = 200000;  // rays per round: about a second
constexpr int kProbeRounds = 4;
constexpr double kProbeSpread = 8.0;  // cells
constexpr double kTubeRadius = 0.6;   // cells: radius opened around a line of sight
constexpr double kTubeMin = 0.15;     // cells from the surface, for the nodes nearest to the line

double Band(const SurfaceWrapOptions& options) {
  // One cell beyond the wall: both ends of the edges that its surface crosses have a distance.
  return std::max(options.closing, 0.5 * options.wall + options.cell) + 0.05 * options.cell;
}

class Wrapper {
 public:
  Wrapper(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options)
      : mesh_(mesh), options_(options), grid_(mesh, options.cell, Band(options), kWrapMargin) {
    outside_.assign(grid_.count(), 0);
  }

  SurfaceWrap Run() {
    FloodFromBorder();
    Creep(Front(), options_.growth_steps);
    if (!MeetsAll()) {
      Creep(Front(), std::numeric_limits<int>::max());
      CarveLinesOfSight();
    }
    SurfaceWrap wrap;
    ScalarGrid field = Field(&wrap.sheet_share);
    wrap.mesh = ExtractIsosurface(field, 0.0f);
    DropBubbles(&wrap.mesh);
    if (options_.reach > 0.0 && !wrap.mesh.empty() && CarveWalls(wrap.mesh, &field)) {
      wrap.mesh = ExtractIsosurface(field, 0.0f);
      DropBubbles(&wrap.mesh);
    }
    return wrap;
  }

 private:
  // Calls visit(neighbour, edge's lower node, axis) for the neighbours within the grid.
  template <typename Visit>
  void ForNeighbours(std::size_t node, const Visit& visit) const {
    const auto& size = grid_.size();
    const auto& stride = grid_.stride();
    const std::array<std::size_t, 3> at = {node % stride[1], node / stride[1] % size[1],
                                           node / stride[2]};
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] > 0) visit(node - stride[axis], node - stride[axis], axis);
      if (at[axis] + 1 < static_cast<std::size_t>(size[axis])) {
        visit(node + stride[axis], node, axis);
      }
    }
  }

  // An edge between two nodes that are both farther than half a cell crosses no triangle.
  void FloodFromBorder() {
    const float clear = static_cast<float>(std::max(options_.closing, 0.5 * options_.cell));
    std::vector<std::size_t> queue{0};
    outside_[0] = 1;
    while (!queue.empty()) {
      core::CheckCancelled();
      std::vector<std::size_t> next;
      for (const std::size_t node : queue) {
        ForNeighbours(node, [&](std::size_t other, std::size_t, int) {
          if (!outside_[other] && grid_.Distance(other) > clear) {
            outside_[other] = 1;
            next.push_back(other);
          }
        });
      }
      queue.swap(next);
    }
  }

  // Returns the outside nodes with a neighbour that is not outside, possibly with repetitions.
  // Every such neighbour is near the surface and so has a distance.
  std::vector<std::size_t> Front() const {
    std::vector<std::size_t> front;
    for (std::size_t node = 0; node < grid_.count(); ++node) {
      if (outside_[node] || grid_.Distance(node) == SurfaceGrid::kFar) continue;
      ForNeighbours(node, [&](std::size_t other, std::size_t, int) {
        if (outside_[other]) front.push_back(other);
      });
    }
    return front;
  }

  void Creep(std::vector<std::size_t> front, int steps) {
    for (int step = 0; step < steps && !front.empty(); ++step) {
      core::CheckCancelled();
      std::vector<std::size_t> next;
      for (const std::size_t node : front) {
        ForNeighbours(node, [&](std::size_t other, std::size_t low, int axis) {
          if (!outside_[other] && !grid_.Crossed(low, axis)) {
            outside_[other] = 1;
            next.push_back(other);
          }
        });
      }
      front.swap(next);
    }
  }

  // Returns true if an outside node is within `reach` cells (at most 2) of a point given in cells,
  // on the side of the point that `front` points to.
  bool NearOutside(const Vector3d& at, const Vector3d& front, double reach) const {
    std::array<int, 3> low;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::clamp(static_cast<int>(at[axis]), 1, grid_.size()[axis] - 3);
    }
    for (int n = 0; n < 64; ++n) {
      const std::array<int, 3> node = {low[0] - 1 + n % 4, low[1] - 1 + n / 4 % 4,
                                       low[2] - 1 + n / 16};
      if (!outside_[Index(node)]) continue;
      const Vector3d offset = Vector3d(node[0], node[1], node[2]) - at;
      if (offset.squaredNorm() <= reach * reach && offset.dot(front) > 0.0) {
        return true;
      }
    }
    return false;
  }

  std::size_t Index(const std::array<int, 3>& node) const {
    return node[0] + grid_.stride()[1] * node[1] + grid_.stride()[2] * node[2];
  }

  Vector3d InCells(const Vector3d& point) const { return (point - grid_.origin()) / grid_.cell(); }

  bool MeetsAll() const {
    return std::all_of(
        options_.visible_hits.begin(), options_.visible_hits.end(),
        [&](const OuterHit& hit) { return NearOutside(InCells(hit.point), hit.normal, kReached); });
  }

  // Opens the lines of sight to points that no outside node is near, then probes around each of
  // them for more: a slit that one ray in ten thousand enters is carved along its whole mouth.
  void CarveLinesOfSight() {
    std::vector<OuterHit> hidden;
    for (const OuterHit& hit : options_.visible_hits) {
      if (Carve(hit)) hidden.push_back(hit);
    }
    if (hidden.empty()) return;
    const TriangleTree tree(mesh_);
    for (int round = 0; round < kProbeRounds && !hidden.empty(); ++round) {
      const int looks = std::min(kProbes, kProbeBudget / static_cast<int>(hidden.size()));
      std::vector<std::vector<OuterHit>> found(hidden.size());
      core::ParallelFor(static_cast<int>(hidden.size()), [&](int h) {
        core::Rng rng = core::StreamRng(static_cast<std::uint64_t>(round), h);
        for (int look = 0; look < looks; ++look)
          found[h].push_back(ProbeNear(tree, hidden[h], rng));
      });
      hidden.clear();
      for (const auto& some : found) {
        for (const OuterHit& hit : some) {
          if (!Carve(hit)) continue;
          hidden.push_back(hit);
          options_.visible_hits.push_back(hit);
        }
      }
    }
  }

  // Returns the first hit of a random ray close to that of `hit`, from beyond the mesh.
  OuterHit ProbeNear(const TriangleTree& tree, const OuterHit& hit, core::Rng& rng) const {
    const double spread = kProbeSpread * grid_.cell();
    const double away = 2.0 * grid_.cell() * (grid_.size()[0] + grid_.size()[1] + grid_.size()[2]);
    // Perturb the direction about the hit, and the hit point itself.
    const Vector3d target = hit.point + spread * core::Uniform(rng) * core::UniformDirection(rng);
    const Vector3d eye = hit.point + 30.0 * spread * hit.to_eye +
                         10.0 * spread * core::Uniform(rng) * core::UniformDirection(rng);
    const Vector3d to_eye = (eye - target).normalized();
    const Vector3d from = target + away * to_eye;
    const auto first = tree.FirstHit(from, -to_eye, 2.0 * away);
    OuterHit result = hit;
    if (!first) return result;
    result.point = first->point;
    result.to_eye = to_eye;
    result.normal = tree.Normal(first->triangle);
    if (result.normal.dot(to_eye) < 0.0) result.normal = -result.normal;
    return result;
  }

  // Opens one line of sight: the nodes nearest to it become outside, back to the outside region.
  // Also enters hollows that the line crosses away from the surface. Returns true if anything was
  // opened.
  bool Carve(const OuterHit& hit) {
    Vector3d at = InCells(hit.point);
    if (NearOutside(at, hit.normal, kReached)) return false;
    std::vector<std::size_t> hollow;
    const int steps = 2 * (grid_.size()[0] + grid_.size()[1] + grid_.size()[2]);
    for (int step = 0; step < steps && !NearOutside(at, hit.to_eye, 1.25);
         ++step, at += 0.5 * hit.to_eye) {
      const std::size_t index = NodeAt(at);
      outside_[index] = 1;
      // Within 0.87 cells of the line: farther than that from the surface, on the same side.
      if (grid_.Distance(index) > 0.9 * grid_.cell()) hollow.push_back(index);
    }
    if (!hollow.empty()) Creep(std::move(hollow), std::numeric_limits<int>::max());
    return true;
  }

  // Carves the lines of sight to visible points that the walls of sheets cover; returns true if
  // there were any.
  bool CarveWalls(const core::TriangleMesh& mesh, ScalarGrid* field) const {
    const TriangleTree tree(mesh);
    const int count = static_cast<int>(options_.visible_hits.size());
    std::vector<char> buried(options_.visible_hits.size());
    constexpr int kBlock = 1024;
    core::ParallelFor((count + kBlock - 1) / kBlock, [&](int block) {
      for (int h = block * kBlock; h < std::min(count, (block + 1) * kBlock); ++h) {
        buried[h] = !tree.Within(options_.visible_hits[h].point, options_.reach);
      }
    });
    bool carved = false;
    for (std::size_t h = 0; h < buried.size(); ++h) {
      if (!buried[h]) continue;
      carved = true;
      OpenTube(options_.visible_hits[h], field);
    }
    return carved;
  }

  // Opens a round tube along a line of sight, from the visible point to the grid's border: adjacent
  // tubes form a smooth slot. The nodes nearest to the line are always opened, each a neighbour of
  // the previous one, so that the tube is connected to the outside.
  void OpenTube(const OuterHit& hit, ScalarGrid* field) const {
    const Vector3d start = InCells(hit.point);
    const Vector3d last(grid_.size()[0] - 2.0, grid_.size()[1] - 2.0, grid_.size()[2] - 2.0);
    int main_axis = 0;
    hit.to_eye.cwiseAbs().maxCoeff(&main_axis);
    const double sign = hit.to_eye[main_axis] < 0.0 ? -1.0 : 1.0;
    const Vector3d step = hit.to_eye / std::abs(hit.to_eye[main_axis]);  // one layer of nodes
    const int u = (main_axis + 1) % 3;
    const int v = (main_axis + 2) % 3;
    std::array<int, 3> previous = RoundedNode(start);
    Open(field, Index(previous), kTubeMin);
    const double first = sign * std::ceil(sign * start[main_axis]);
    Vector3d at = start + std::abs(first - start[main_axis]) * step;
    for (; (at.array() >= 1.0).all() && (at.array() <= last.array()).all(); at += step) {
      std::array<int, 3> node;
      node[main_axis] = static_cast<int>(std::lround(at[main_axis]));
      for (int n = 0; n < 25; ++n) {
        node[u] = static_cast<int>(std::lround(at[u])) + n % 5 - 2;
        node[v] = static_cast<int>(std::lround(at[v])) + n / 5 - 2;
        if (node[u] < 0 || node[v] < 0 || node[u] >= grid_.size()[u] ||
            node[v] >= grid_.size()[v]) {
          continue;
        }
        const Vector3d offset = Vector3d(node[0], node[1], node[2]) - start;
        const double along = offset.dot(hit.to_eye);
        const double beside = (offset - along * hit.to_eye).norm();
        Open(field, Index(node), std::min(kTubeRadius - beside, along));
      }
      const std::array<int, 3> next = RoundedNode(at);
      for (int axis = 0; axis < 3; ++axis) {
        if (previous[axis] == next[axis]) continue;
        previous[axis] = next[axis];
        Open(field, Index(previous), kTubeMin);
      }
    }
  }

  // Raises the field at `node` to `value`, in cells.
  void Open(ScalarGrid* field, std::size_t node, double value) const {
    field->values[node] = std::max(field->values[node], static_cast<float>(value * grid_.cell()));
  }

  std::array<int, 3> RoundedNode(const Vector3d& at) const {
    std::array<int, 3> node;
    for (int axis = 0; axis < 3; ++axis) {
      node[axis] = std::clamp(static_cast<int>(std::lround(at[axis])), 1, grid_.size()[axis] - 2);
    }
    return node;
  }

  std::size_t NodeAt(const Vector3d& at) const { return Index(RoundedNode(at)); }

  // Returns true if there is solid behind the surface, seen from an outside node: an inside node
  // deep enough that the part is at least a cell thick there.
  bool SolidBehind(std::size_t node) const {
    const Vector3d position = grid_.Position(node);
    const Vector3d surface = grid_.Nearest(node);
    Vector3d into = surface - position;
    const double length = into.norm();
    if (!(length > 0.0)) return true;
    into /= length;
    const auto& stride = grid_.stride();
    const auto& size = grid_.size();
    for (const double depth : {0.75, 1.6}) {
      const Vector3d probe = (surface - grid_.origin()) / grid_.cell() + depth * into;
      std::array<std::size_t, 3> low;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<std::size_t>(std::clamp(probe[axis], 0.0, size[axis] - 2.0));
      }
      const std::size_t base = low[0] + stride[1] * low[1] + stride[2] * low[2];
      for (int c = 0; c < 8; ++c) {
        const std::size_t other =
            base + (c & 1) + (c & 2 ? stride[1] : 0) + (c & 4 ? stride[2] : 0);
        if (!outside_[other] && grid_.Distance(other) >= 0.5 * grid_.cell()) return true;
      }
    }
    return false;
  }

  ScalarGrid Field(double* sheet_share) const {
    ScalarGrid field;
    field.origin = grid_.origin();
    field.cell = grid_.cell();
    field.nx = grid_.size()[0];
    field.ny = grid_.size()[1];
    field.nz = grid_.size()[2];
    field.values.resize(grid_.count());
    const float far = static_cast<float>(Band(options_));
    const double half_wall = 0.5 * options_.wall;
    std::atomic<long> near{0};
    std::atomic<long> sheets{0};
    core::ParallelFor(field.nz, [&](int k) {
      core::CheckCancelled();
      const std::size_t first = grid_.stride()[2] * k;
      long near_here = 0;
      long sheets_here = 0;
      for (std::size_t node = first; node < first + grid_.stride()[2]; ++node) {
        const float distance = std::min(grid_.Distance(node), far);
        if (!outside_[node]) {
          field.values[node] = -distance;
          continue;
        }
        field.values[node] = distance;
        if (grid_.Distance(node) == SurfaceGrid::kFar) continue;
        ++near_here;
        if (SolidBehind(node)) continue;
        ++sheets_here;
        field.values[node] = static_cast<float>(distance - half_wall);
      }
      near += near_here;
      sheets += sheets_here;
    });
    *sheet_share = near > 0 ? static_cast<double>(sheets) / static_cast<double>(near) : 0.0;
    return field;
  }

  // Removes the hollows that the outside reached through gaps which the wall closed again, except
  // those that are visible from outside.
  void DropBubbles(core::TriangleMesh* mesh) const {
    if (mesh->empty()) return;
    int count = 0;
    const std::vector<int> component = EdgeComponents(*mesh, &count);
    const std::vector<double> volumes = ComponentVolumes(*mesh, component, count);
    std::vector<char> keep(count);
    for (int c = 0; c < count; ++c) keep[c] = volumes[c] > 0.0;
    if (std::all_of(keep.begin(), keep.end(), [](char kept) { return kept; })) return;
    KeepSeenBubbles(*mesh, component, &keep);
    std::vector<Eigen::Vector3i> kept;
    for (std::size_t t = 0; t < component.size(); ++t) {
      if (keep[component[t]]) kept.push_back(mesh->triangles[t]);
    }
    mesh->triangles.swap(kept);
    RemoveBuriedComponents(mesh);
  }

  // Keeps the bubbles of which a visible point has a vertex, and none of the outer surface, within
  // about a cell.
  void KeepSeenBubbles(const core::TriangleMesh& mesh, const std::vector<int>& component,
                       std::vector<char>* keep) const {
    constexpr int kNone = -1;
    constexpr int kOuter = -2;
    std::unordered_map<std::size_t, int> owner;  // by lower node
    for (std::size_t t = 0; t < component.size(); ++t) {
      const bool outer = (*keep)[component[t]];
      for (int c = 0; c < 3; ++c) {
        const Vector3d at = InCells(mesh.vertices[mesh.triangles[t][c]]);
        int& cell = owner.try_emplace(CellOf(at), kNone).first->second;
        if (outer) cell = kOuter;
        if (!outer && cell == kNone) cell = component[t];
      }
    }
    for (const OuterHit& hit : options_.visible_hits) {
      const std::size_t base = CellOf(InCells(hit.point));
      int bubble = kNone;
      for (int n = 0; n < 27 && bubble != kOuter; ++n) {
        const std::size_t cell = base + n % 3 + grid_.stride()[1] * (n / 3 % 3) +
                                 grid_.stride()[2] * (n / 9) - 1 - grid_.stride()[1] -
                                 grid_.stride()[2];
        const auto found = owner.find(cell);
        if (found != owner.end()) bubble = found->second;
      }
      if (bubble >= 0) (*keep)[bubble] = 1;
    }
  }

  std::size_t CellOf(const Vector3d& at) const {
    std::array<int, 3> node;
    for (int axis = 0; axis < 3; ++axis) {
      node[axis] = std::clamp(static_cast<int>(at[axis]), 1, grid_.size()[axis] - 2);
    }
    return Index(node);
  }

  const core::TriangleMesh& mesh_;
  SurfaceWrapOptions options_;
  const SurfaceGrid grid_;
  std::vector<std::uint8_t> outside_;
};

}  // namespace

double WrapGridNodes(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options) {
  const std::array<int, 3> size = SurfaceGrid::Size(mesh, options.cell, Band(options), kWrapMargin);
  return static_cast<double>(size[0]) * size[1] * size[2];
}

SurfaceWrap WrapSurface(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options) {
  core::RequireValid(mesh, "surface wrap");
  if (mesh.empty()) throw core::Error("the mesh has no faces", "surface wrap");
  if (!(options.cell > 0.0) || !(options.wall >= 0.0) || !(options.closing >= 0.0)) {
    throw core::Error("the cell must be positive, closing and wall not negative", "surface wrap");
  }
  if (!(WrapGridNodes(mesh, options) < 2e9)) {
    throw core::Error("the cell is too small for the mesh", "surface wrap", "use a larger cell");
  }
  return Wrapper(mesh, options).Run();
}

}  // namespace simwright::geometry
