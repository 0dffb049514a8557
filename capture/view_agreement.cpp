#include "capture/view_agreement.h"

#include <algorithm>
#include <cmath>

#include "capture/coverage.h"
#include "capture/object_masks.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr double kLeastAgreement = 0.75;  // IoU of a view's mask and the hull's silhouette

// Raises each value to at least that of `least`.
void Raise(const core::FloatImage& least, core::FloatImage* values) {
  for (std::size_t i = 0; i < values->values.size(); ++i) {
    values->values[i] = std::max(values->values[i], least.values[i]);
  }
}

}  // namespace

double MaskIou(const core::FloatImage& a, const core::FloatImage& b) {
  double both = 0.0, either = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const bool in_a = a.values[i] >= 0.5f, in_b = b.values[i] >= 0.5f;
    both += in_a && in_b;
    either += in_a || in_b;
  }
  return either > 0.0 ? both / either : 1.0;
}

HullVote VoteOf(const std::vector<CaptureView>& views, double tolerated,
                const std::vector<core::FloatImage>& open) {
  HullVote vote;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const core::FloatImage& opacity = views[i].opacity;
    const bool any = std::any_of(opacity.values.begin(), opacity.values.end(),
                                 [](float v) { return v >= 0.5f; });
    if (!any) continue;
    asset_lift::ObservedView view;
    view.camera = views[i].camera;
    view.opacity = opacity;
    if (!open.empty() && !open[i].empty()) Raise(open[i], &view.opacity);
    vote.views.push_back(std::move(view));
  }
  vote.tolerated =
      static_cast<int>(std::lround(tolerated * static_cast<double>(vote.views.size())));
  return vote;
}

core::TriangleMesh HullOf(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                          int cells, double margin) {
  const bool enough = std::all_of(votes.begin(), votes.end(), [](const HullVote& vote) {
    return static_cast<int>(vote.views.size()) > vote.tolerated + 1;
  });
  if (!enough) return {};
  return VotingHull(votes, box, {cells, 0.0, margin});
}

Eigen::AlignedBox3d Grown(Eigen::AlignedBox3d box) {
  const double margin = 0.06 * box.diagonal().norm();
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

void LeaveOutContradictions(const CaptureSource& source, Capture* capture) {
  std::vector<double> agreement(capture->views.size());
  core::ParallelFor(static_cast<int>(agreement.size()), [&](int i) {
    const CaptureView& view = capture->views[static_cast<std::size_t>(i)];
    agreement[static_cast<std::size_t>(i)] =
        MaskIou(view.opacity, SilhouetteOf(capture->hull, view.camera));
  });
  std::vector<CaptureView> kept;
  std::vector<MatCalibration::View> poses;
  for (std::size_t i = 0; i < agreement.size(); ++i) {
    if (agreement[i] >= kLeastAgreement) {
      kept.push_back(std::move(capture->views[i]));
      poses.push_back(capture->calibration.views[i]);
      continue;
    }
    capture->findings.push_back(
        {"view-contradicts", core::Severity::kWarning,
         source.photos[static_cast<std::size_t>(capture->views[i].index)].name,
         "the outline of the object contradicts the other photos: the photo is left out",
         agreement[i], "look at capture.html; the object must not move between photos"});
  }
  if (static_cast<int>(kept.size()) < kMinCalibrationPhotos || 2 * kept.size() < agreement.size()) {
    throw core::Error("the outlines of the object agree in " + std::to_string(kept.size()) +
                          " of " + std::to_string(agreement.size()) + " photos only",
                      "capture",
                      "leave one object where it stands, move around it, and choose a background "
                      "of other colours; clear glass and mirrors have no outline: dull them with "
                      "removable powder");
  }
  capture->views = std::move(kept);
  capture->calibration.views = std::move(poses);
}

void AdviseMorePhotos(Capture* capture) {
  const Eigen::Vector3d object = core::Bounds(capture->hull).center();
  std::vector<ViewDirection> directions;
  for (const CaptureView& view : capture->views) {
    directions.push_back(DirectionTo(object, view.camera.position()));
  }
  const core::Findings missing = MissingViews(directions);
  capture->findings.insert(capture->findings.end(), missing.begin(), missing.end());
}

}  // namespace simwright::capture
