#include "capture/start_shape.h"

#include <utility>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "capture/view_matte.h"
#include "core/error.h"

namespace simwright::capture {
namespace {

// Sets the mesh to a field's surface, unless the field is empty.
void TakeSurface(const geometry::ScalarGrid& field, core::TriangleMesh* mesh) {
  const core::TriangleMesh surface = geometry::ExtractIsosurface(field, 0.0f);
  if (!surface.empty()) *mesh = asset_lift::LargeComponents(surface);
}

}  // namespace

StartShape MakeStartShape(const Capture& capture, int side, const StartShapeOptions& options,
                          core::Progress* progress) {
  StartShape start;
  for (const CaptureView& view : capture.views) {
    const asset_lift::Matte matte = MatteOf(view);
    if (matte.right <= matte.left) continue;
    start.views.push_back(asset_lift::CropView(
        view.photo, matte.alpha, asset_lift::FrameAround(matte, view.camera, 1.0), side));
  }
  if (start.views.empty()) throw core::Error("no view has a mask", "capture");
  start.mesh = capture.hull;
  geometry::ScalarGrid field;
  if (options.lower_peaks) {
    field = HullField(capture.hull, options.field);
    LowerPeaks(start.views, options.flat_tops, &field);
    TakeSurface(field, &start.mesh);
  }
  if (!options.use_stereo) return start;
  StereoDepths stereo = FindStereoDepths(start.views, capture.hull, options.stereo, progress);
  if (stereo.share < options.least_share) return start;
  start.depth_share = stereo.share;
  for (std::size_t i = 0; i < start.views.size(); ++i) {
    start.views[i].depth = std::move(stereo.depths[i]);
  }
  if (!options.lower_peaks) field = HullField(capture.hull, options.field);
  CarveByDepth(start.views, options.carving, &field);
  TakeSurface(field, &start.mesh);
  return start;
}

}  // namespace simwright::capture
