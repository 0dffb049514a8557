#include "capture/capture_lift.h"

#include <cmath>
#include <string>
#include <utility>

#include "asset_lift/mesh_fit/shape_fit.h"
#include "asset_lift/outline/inflation.h"
#include "asset_lift/priors/initial_shape.h"
#include "capture/view_matte.h"
#include "core/error.h"
#include "geometry/weld.h"
#include "texture/photo_projection.h"

namespace simwright::capture {
namespace {

std::string StartName(const StartShape& start) {
  const std::string hull = "the visual hull of " + std::to_string(start.views.size()) + " photos";
  return start.depth_share > 0.0 ? hull + ", carved by stereo," : hull;
}

// Limits of the share of the hull's volume that stereo carved away, and of the object's pixels
// whose depth it found, above which the shape rests on depths.
constexpr double kMostCarved = 0.1, kMostMeasured = 0.25;

double CarvedShare(const Capture& capture, const StartShape& start) {
  const double hull = geometry::SignedVolume(capture.hull);
  return hull > 0.0 ? 1.0 - geometry::SignedVolume(start.mesh) / hull : 0.0;
}

core::Finding StereoFinding(const StartShape& start) {
  if (start.depth_share > 0.0) {
    return {"stereo", core::Severity::kInfo, "",
            "stereo found the depth of " + std::to_string(std::lround(100.0 * start.depth_share)) +
                " % of the object's pixels",
            start.depth_share};
  }
  return {"stereo", core::Severity::kInfo, "",
          "the object has too little texture for stereo: its shape rests on outlines and colours",
          0.0};
}

}  // namespace

CaptureLiftOptions::CaptureLiftOptions() {
  fit.field_stage = false;
  fit.mesh.max_side = fit_side;
  fit.mesh.first_edge_ratio = 0.03;
  fit.mesh.last_edge_ratio = 0.012;
  fit.mesh.depth_tolerance = 0.01;
  fit.mesh.first_area_weight = 0.6;
  fit.mesh.last_area_weight = 0.1;
  fit.mesh.stands_on_floor = true;
}

asset_lift::LiftedMesh LiftCapture(const Capture& capture, const CaptureLiftOptions& options,
                                   core::Progress* progress) {
  return LiftCapture(capture, MakeStartShape(capture, options.fit_side, options.start, progress),
                     options, progress);
}

asset_lift::LiftedMesh LiftCapture(const Capture& capture, const StartShape& start,
                                   const CaptureLiftOptions& options, core::Progress* progress) {
  asset_lift::LiftedMesh lifted;
  lifted.findings = capture.findings;
  std::vector<texture::PhotoView> photos;
  for (const CaptureView& view : capture.views) {
    asset_lift::Matte matte = MatteOf(view);
    if (matte.right <= matte.left) continue;
    photos.push_back({view.camera, view.photo, matte.alpha});
    if (photos.size() == 1) lifted.matte = std::move(matte);
  }
  if (photos.empty()) throw core::Error("no view has a mask", "capture");
  if (options.start.use_stereo) lifted.findings.push_back(StereoFinding(start));
  asset_lift::ShapeFitOptions stages = options.fit;
  stages.field.seed = stages.mesh.seed = options.seed;
  stages.mesh.max_side = options.fit_side;
  // The least area would close the hollows that stereo found.
  if (CarvedShare(capture, start) > kMostCarved || start.depth_share > kMostMeasured) {
    stages.mesh.first_area_weight = stages.mesh.last_area_weight = 0.0;
  }
  const asset_lift::ShapeFit fit = asset_lift::FitShape(
      start.views, asset_lift::InitialShapeFrom(start.mesh), nullptr, nullptr, stages, progress);
  lifted.findings.insert(lifted.findings.end(), fit.findings.begin(), fit.findings.end());
  progress->Stage("texture");
  texture::PhotoProjectionOptions projection;
  projection.texture_size = options.texture_size;
  lifted.mesh = texture::ProjectPhotos(fit.mesh, photos, fit.colors, projection);
  lifted.camera = photos[0].camera;
  lifted.photo = photos[0].photo;
  lifted.start = StartName(start);
  lifted.silhouette_iou = asset_lift::SilhouetteIou(fit.mesh, lifted.camera, lifted.matte);
  lifted.findings.push_back(
      {"shape", core::Severity::kInfo, "",
       "the shape began as " + lifted.start + (capture.paper ? " on a mat" : " on a table"),
       lifted.silhouette_iou});
  progress->Finish();
  return lifted;
}

}  // namespace simwright::capture
