#include "workflows/lift/mat_lift.h"

#include <chrono>
#include <cmath>
#include <numbers>

#include "capture/capture_lift.h"
#include "capture/mat_detection.h"
#include "capture/turned_set.h"
#include "core/error.h"
#include "core/files.h"
#include "workflows/lift/capture_report.h"
#include "workflows/lift/lift_finishing.h"
#include "workflows/lift/photo_source.h"

namespace simwright::workflows {
namespace {

constexpr double kNominalRuler = 0.1;  // m

std::string Percent(double share) {
  return std::to_string(std::lround(100.0 * share)) + " %";
}

// Adds the photos of the flipped object to the source and, where their pose can be trusted, to the
// capture. The photos that cannot be used are left out with a finding.
void AddFlipped(const capture::CaptureSource& flipped, const capture::CaptureOptions& options,
                std::uint64_t seed, capture::CaptureSource* source, capture::Capture* capture,
                core::Progress* progress) {
  const auto leave_out = [&](const std::string& why, double figure) {
    capture->findings.push_back(
        {"flipped-left-out", core::Severity::kWarning, "--flipped",
         "the photos of the flipped object are not used: " + why, figure,
         "photograph the same object, turned onto another side, from all around on the mat"});
  };
  capture::Capture second;
  try {
    second = capture::CaptureOnMat(flipped, options, progress);
  } catch (const core::Error& error) {
    leave_out(error.what(), 0.0);
    return;
  }
  const capture::TurnedPose pose = capture::FindTurnedPose(*capture, second, seed, progress);
  if (!pose.doubt.empty()) {
    leave_out(pose.doubt, pose.agreement);
    return;
  }
  const int count = static_cast<int>(source->photos.size());
  source->photos.insert(source->photos.end(), flipped.photos.begin(), flipped.photos.end());
  source->read = [count, first = source->read, second = flipped.read](int index) {
    return index < count ? first(index) : second(index - count);
  };
  const std::size_t added = second.views.size();
  for (core::Finding& finding : second.findings) {
    if (finding.code != "more-photos") capture->findings.push_back(std::move(finding));
  }
  capture::MergeTurned(second, pose.first_from_second, count, options, capture);
  const double turn = Eigen::AngleAxisd(pose.first_from_second.linear()).angle();
  capture->findings.push_back({"flipped", core::Severity::kInfo, "--flipped",
                               std::to_string(added) + " photos of the object turned by " +
                                   std::to_string(std::lround(turn * 180.0 / std::numbers::pi)) +
                                   " degrees were added: the outlines of both sets agree to " +
                                   Percent(pose.agreement) + ", their colours differ by " +
                                   Percent(pose.color_difference),
                               pose.agreement});
}

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
                            NamedOr(request.source, request.photos) + " on a mat",
                            physics_params::RequireCategory(request.category),
                            0.0,
                            request.size,
                            request.stated,
                            request.budget,
                            true,
                            request.seed};
  const auto start = std::chrono::steady_clock::now();
  capture::CaptureSource source = SourceOf(request.photos);
  const capture::CaptureSource flipped = SourceOf(request.flipped);
  capture::CaptureOptions options;
  options.print_scale = request.ruler / kNominalRuler;
  capture::Capture capture = capture::CaptureOnMat(source, options, progress);
  if (!request.flipped.empty()) {
    AddFlipped(flipped, options, request.seed, &source, &capture, progress);
  }
  capture.findings.insert(capture.findings.begin(), request.findings.begin(),
                          request.findings.end());
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
