#include "workflows/lift/table_lift.h"

#include <algorithm>
#include <chrono>

#include "capture/capture_lift.h"
#include "capture/table_capture.h"
#include "core/error.h"
#include "core/files.h"
#include "workflows/lift/capture_report.h"
#include "workflows/lift/lift_finishing.h"
#include "workflows/lift/photo_source.h"

namespace simwright::workflows {
namespace {

constexpr std::size_t kPhotosCompared = 3;
constexpr int kComparedSide = 640;         // pixels
constexpr std::size_t kSharedTracks = 80;  // from which two photos show one scene

}  // namespace

LiftOutcome LiftToFolder(const TableLiftRequest& request, core::Progress* progress) {
  core::StagedFolder staged(request.output, request.force);
  const Finishing finishing{request.output,
                            NamedOr(request.source, request.photos) + " of one object",
                            physics_params::RequireCategory(request.category),
                            request.height,
                            request.size,
                            request.stated,
                            request.budget,
                            false,
                            request.seed};
  const auto start = std::chrono::steady_clock::now();
  const capture::CaptureSource source = SourceOf(request.photos);
  capture::TableCaptureOptions options;
  options.seed = request.seed;
  capture::Capture capture = capture::CaptureOnTable(source, options, progress);
  capture.findings.insert(capture.findings.begin(), request.findings.begin(),
                          request.findings.end());
  capture::ScaleCapture(ScaleToMetres(finishing, capture.hull), &capture);
  capture::CaptureLiftOptions fit;
  fit.seed = request.seed;
  asset_lift::LiftedMesh lifted = capture::LiftCapture(capture, fit, progress);
  // The fitted mesh gives the size, and the cameras follow it.
  const double scale = ScaleToMetres(finishing, lifted.mesh.mesh);
  capture::ScaleCapture(scale, &capture);
  core::Transform(Eigen::Affine3d(Eigen::Scaling(scale)), &lifted.mesh.mesh);
  lifted.camera.world_from_camera.translation() *= scale;
  if (PriorOf(*finishing.category.category).open) {
    lifted.findings.push_back({"hollow-uncertain", core::Severity::kWarning, request.category,
                               "outlines do not show how deep its hollow is: it may be too shallow",
                               0.0, "look at preview.png"});
  }
  WriteCaptureReport(source, capture, staged.staging());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return FinishLift(finishing, seconds, std::move(lifted), &staged, progress);
}

bool ShowOneScene(const std::vector<std::filesystem::path>& photos) {
  std::vector<core::Image> first;
  for (std::size_t i = 0; i < std::min(photos.size(), kPhotosCompared); ++i) {
    try {
      core::ImageReadOptions options;
      options.max_side = kComparedSide;
      first.push_back(core::ReadImage(photos[i], options));
    } catch (const core::Error&) {
      continue;  // the reconstruction reports it
    }
  }
  if (first.size() < 2) return false;
  capture::FeatureTrackOptions options;
  options.max_side = kComparedSide;
  options.max_features = 1000;
  core::Progress silent;
  const capture::PhotoTracks found = capture::FindFeatureTracks(
      static_cast<int>(first.size()), [&](int i) { return first[static_cast<std::size_t>(i)]; },
      options, &silent);
  return found.tracks.size() >= kSharedTracks;
}

}  // namespace simwright::workflows
