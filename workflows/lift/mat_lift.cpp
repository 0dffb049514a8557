#include "workflows/lift/mat_lift.h"

#include <chrono>

#include "capture/capture_lift.h"
#include "capture/mat_detection.h"
#include "core/error.h"
#include "core/files.h"
#include "workflows/lift/capture_report.h"
#include "workflows/lift/lift_finishing.h"
#include "workflows/lift/photo_source.h"

namespace simwright::workflows {
namespace {

constexpr double kNominalRuler = 0.1;  // m

}  // namespace

bool ShowMat(const std::vector<std::filesystem::path>& photos) {
  if (photos.size() < 2) return false;
  int shown = 0;
  for (const std::filesystem::path& path : photos) {
    try {
      shown += capture::DetectMat(core::ReadImage(path)).has_value();
    } catch (const core::Error&) {
      continue;  // the reconstruction reports it
    }
    if (shown >= 2) return true;
  }
  return false;
}

LiftOutcome LiftToFolder(const MatLiftRequest& request, core::Progress* progress) {
  core::StagedFolder staged(request.output, request.force);
  const Finishing finishing{request.output,
                            std::to_string(request.photos.size()) + " photos on a mat",
                            physics_params::RequireCategory(request.category),
                            0.0,
                            request.size,
                            request.stated,
                            true,
                            request.seed};
  const auto start = std::chrono::steady_clock::now();
  const capture::CaptureSource source = SourceOf(request.photos);
  capture::CaptureOptions options;
  options.print_scale = request.ruler / kNominalRuler;
  const capture::Capture capture = capture::CaptureOnMat(source, options, progress);
  capture::CaptureLiftOptions fit;
  fit.seed = request.seed;
  asset_lift::LiftedMesh lifted = capture::LiftCapture(capture, fit, progress);
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

}  // namespace simwright::workflows
