#include "capture/start_shape.h"

#include "asset_lift/multi_view/visual_hull.h"
#include "capture/view_agreement.h"
#include "capture/voting_hull.h"

namespace simwright::capture {

StartShape MakeStartShape(const Capture& capture, const StartShapeOptions& options,
                          core::Progress* progress) {
  progress->Stage("hull");
  Eigen::AlignedBox3d box = core::Bounds(capture.hull);
  const double margin = 0.02 * box.diagonal().norm();
  box.min().array() -= margin;
  box.max().array() += margin;
  const HullVote vote = VoteOf(capture.views, options.tolerated_views, {});
  if (static_cast<int>(vote.views.size()) <= vote.tolerated + 1) return {capture.hull};
  geometry::ScalarGrid field = VotingHullField({vote}, box, {options.cells, 0.0});
  if (options.lower_peaks) LowerPeaks(vote.views, options.flat_tops, &field);
  core::TriangleMesh mesh = geometry::ExtractIsosurface(field, 0.0f);
  if (mesh.empty()) return {capture.hull};
  return {asset_lift::LargeComponents(mesh)};
}

}  // namespace simwright::capture
