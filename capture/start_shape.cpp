#include "capture/start_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "asset_lift/multi_view/visual_hull.h"
#include "capture/object_masks.h"
#include "capture/view_agreement.h"
#include "capture/voting_hull.h"

namespace simwright::capture {
namespace {

// Believed masks must be this share of all, or the first hull is kept.
constexpr double kLeastBelieved = 0.6;

// Returns the votes of the masks that agree with the hull, all of which must admit a point; their
// deep holes are filled.
HullVote BelievedMasks(const HullVote& vote, const core::TriangleMesh& hull,
                       const StartShapeOptions& options) {
  HullVote believed;
  believed.tolerated = 0;
  for (const asset_lift::ObservedView& view : vote.views) {
    const core::FloatImage silhouette = SilhouetteOf(hull, view.camera);
    if (MaskIou(view.opacity, silhouette) < options.least_agreement) continue;
    const auto area = std::count_if(silhouette.values.begin(), silhouette.values.end(),
                                    [](float v) { return v >= 0.5f; });
    const auto depth =
        static_cast<float>(options.hole_depth * std::sqrt(static_cast<double>(area)));
    const core::FloatImage distance = asset_lift::MaskDistance(silhouette);
    believed.views.push_back(view);
    core::FloatImage& opacity = believed.views.back().opacity;
    for (std::size_t i = 0; i < opacity.values.size(); ++i) {
      if (distance.values[i] < -depth) opacity.values[i] = 1.0f;
    }
  }
  return believed;
}

}  // namespace

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
  const core::TriangleMesh first = geometry::ExtractIsosurface(field, 0.0f);
  if (first.empty()) return {capture.hull};
  const HullVote believed = BelievedMasks(vote, first, options);
  if (static_cast<double>(believed.views.size()) >=
      std::max(2.0, kLeastBelieved * static_cast<double>(vote.views.size()))) {
    field = VotingHullField({believed}, box, {options.cells, 0.0});
  }
  if (options.lower_peaks) LowerPeaks(vote.views, options.flat_tops, &field);
  core::TriangleMesh mesh = geometry::ExtractIsosurface(field, 0.0f);
  if (mesh.empty()) return {capture.hull};
  return {asset_lift::LargeComponents(mesh)};
}

}  // namespace simwright::capture
