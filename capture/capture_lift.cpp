#include "capture/capture_lift.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/mesh_fit/shape_fit.h"
#include "asset_lift/outline/inflation.h"
#include "asset_lift/priors/initial_shape.h"
#include "core/error.h"
#include "texture/photo_projection.h"

namespace simwright::capture {
namespace {

asset_lift::Matte MatteOf(const CaptureView& view) {
  asset_lift::Matte matte;
  matte.method = "views together";
  matte.alpha = core::Image(view.photo.width, view.photo.height, 1);
  matte.left = view.photo.width;
  matte.top = view.photo.height;
  double sum = 0.0;
  for (int y = 0; y < view.photo.height; ++y) {
    for (int x = 0; x < view.photo.width; ++x) {
      const float share = *view.opacity.At(x, y);
      *matte.alpha.At(x, y) = static_cast<std::uint8_t>(std::lround(255.0f * share));
      sum += share;
      if (share < 0.5f) continue;
      matte.left = std::min(matte.left, x);
      matte.top = std::min(matte.top, y);
      matte.right = std::max(matte.right, x + 1);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
  matte.area = sum / (static_cast<double>(view.photo.width) * view.photo.height);
  return matte;
}

}  // namespace

CaptureLiftOptions::CaptureLiftOptions() {
  fit.field_stage = false;
  fit.mesh.max_side = fit_side;
  fit.mesh.first_edge_ratio = 0.03;
  fit.mesh.last_edge_ratio = 0.012;
}

asset_lift::LiftedMesh LiftCapture(const Capture& capture, const CaptureLiftOptions& options,
                                   core::Progress* progress) {
  asset_lift::LiftedMesh lifted;
  lifted.findings = capture.findings;
  std::vector<asset_lift::ObservedView> views;
  std::vector<texture::PhotoView> photos;
  std::vector<asset_lift::Matte> mattes;
  for (const CaptureView& view : capture.views) {
    mattes.push_back(MatteOf(view));
    if (mattes.back().right <= mattes.back().left) {
      mattes.pop_back();
      continue;
    }
    photos.push_back({view.camera, view.photo, mattes.back().alpha});
    views.push_back(asset_lift::CropView(view.photo, mattes.back().alpha,
                                         asset_lift::FrameAround(mattes.back(), view.camera, 1.0),
                                         options.fit_side));
  }
  if (views.empty()) throw core::Error("no view has a mask", "capture");
  asset_lift::ShapeFitOptions stages = options.fit;
  stages.field.seed = stages.mesh.seed = options.seed;
  stages.mesh.max_side = options.fit_side;
  const asset_lift::ShapeFit fit = asset_lift::FitShape(
      views, asset_lift::InitialShapeFrom(capture.hull), nullptr, nullptr, stages, progress);
  lifted.findings.insert(lifted.findings.end(), fit.findings.begin(), fit.findings.end());
  progress->Stage("texture");
  texture::PhotoProjectionOptions projection;
  projection.texture_size = options.texture_size;
  lifted.mesh = texture::ProjectPhotos(fit.mesh, photos, fit.colors, projection);
  lifted.camera = photos[0].camera;
  lifted.photo = photos[0].photo;
  lifted.matte = mattes[0];
  lifted.start = "the visual hull of " + std::to_string(views.size()) + " photos";
  lifted.silhouette_iou = asset_lift::SilhouetteIou(fit.mesh, lifted.camera, lifted.matte);
  lifted.findings.push_back(
      {"shape", core::Severity::kInfo, "",
       "the shape began as " + lifted.start + (capture.paper ? " on a mat" : " on a table"),
       lifted.silhouette_iou});
  progress->Finish();
  return lifted;
}

}  // namespace simwright::capture
