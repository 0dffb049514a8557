#include "capture/start_shape.h"

#include <utility>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "capture/view_matte.h"
#include "core/error.h"

namespace simwright::capture {
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
  if (!options.use_stereo) return start;
  StereoDepths stereo = FindStereoDepths(start.views, capture.hull, options.stereo, progress);
  if (stereo.share < options.least_share) return start;
  start.depth_share = stereo.share;
  for (std::size_t i = 0; i < start.views.size(); ++i) {
    start.views[i].depth = std::move(stereo.depths[i]);
  }
  geometry::ScalarGrid field = HullField(capture.hull, options.field);
  CarveByDepth(start.views, options.carving, &field);
  const core::TriangleMesh carved = geometry::ExtractIsosurface(field, 0.0f);
  if (!carved.empty()) start.mesh = asset_lift::LargeComponents(carved);
  return start;
}

}  // namespace simwright::capture
