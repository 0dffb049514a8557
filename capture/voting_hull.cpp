#include "capture/voting_hull.h"

#include <algorithm>
#include <functional>

#include "asset_lift/multi_view/visual_hull.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/isosurface.h"

namespace simwright::capture {

namespace {

// The masks' cones of one vote.
class ConeVote {
 public:
  explicit ConeVote(const HullVote& vote) : tolerated_(std::max(0, vote.tolerated)) {
    RequireValid(vote.views);
    if (static_cast<int>(vote.views.size()) <= tolerated_) {
      throw core::Error("it needs more views than it tolerates", "visual hull");
    }
    for (const asset_lift::ObservedView& view : vote.views) cones_.emplace_back(view);
  }

  // Returns the signed distance to the admitted points, m, positive outside. `distances`: scratch.
  double At(const Eigen::Vector3d& point, std::vector<double>* distances) const {
    distances->clear();
    for (const asset_lift::SilhouetteCone& cone : cones_) distances->push_back(cone.At(point));
    const auto decisive = distances->begin() + tolerated_;
    std::nth_element(distances->begin(), decisive, distances->end(), std::greater<>());
    return *decisive;
  }

 private:
  int tolerated_;
  std::vector<asset_lift::SilhouetteCone> cones_;
};

}  // namespace

core::TriangleMesh VotingHull(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                              const VotingHullOptions& options) {
  if (options.cells < 8 || box.isEmpty()) throw core::Error("the grid is empty", "visual hull");
  const std::vector<ConeVote> cones(votes.begin(), votes.end());
  geometry::ScalarGrid field;
  field.cell = box.sizes().maxCoeff() / options.cells;
  const double margin = options.margin * field.cell;
  // A layer of nodes below the floor closes the surface there.
  field.origin = box.min();
  field.origin.z() = std::max(box.min().z(), options.floor - field.cell);
  const Eigen::Vector3d sides = box.max() - field.origin;
  field.nx = static_cast<int>(sides.x() / field.cell) + 2;
  field.ny = static_cast<int>(sides.y() / field.cell) + 2;
  field.nz = static_cast<int>(sides.z() / field.cell) + 2;
  field.values.resize(field.Index(0, 0, field.nz));
  core::ParallelFor(field.nz, [&](int k) {
    core::CheckCancelled();
    std::vector<double> distances;
    for (int j = 0; j < field.ny; ++j) {
      for (int i = 0; i < field.nx; ++i) {
        const Eigen::Vector3d p = field.origin + field.cell * Eigen::Vector3d(i, j, k);
        double outside = options.floor - p.z();
        for (const auto& plane : options.planes) {
          outside = std::max(outside, -plane.signedDistance(p));
        }
        for (const ConeVote& vote : cones) {
          outside = std::max(outside, vote.At(p, &distances) - margin);
        }
        field.values[field.Index(i, j, k)] = static_cast<float>(outside);
      }
    }
  });
  const core::TriangleMesh hull = geometry::ExtractIsosurface(field, 0.0f);
  return hull.empty() ? hull : asset_lift::LargeComponents(hull);
}

}  // namespace simwright::capture
