#include "twin/observed_object.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/priors/shape_example.h"
#include "library_fit/library_fit.h"
#include "library_fit/prior_example.h"

namespace simwright::twin {
namespace {

constexpr double kFitMargin = 1.35;  // of the compared crop around the visible part
constexpr int kVisible = 128;        // alpha from which a pixel shows the object
constexpr double kTouching = 3.0;    // pixels between the boxes of objects that may overlap

// Returns true if `other` may stand before `object`: its lower edge is lower in the photo.
bool MayStandBefore(const Detection& other, const Detection& object) {
  return other.box.max().y() > object.box.max().y();
}

// Marks the crop's pixels outside of the photo and those of nearer objects.
void MarkCovered(const core::Image& photo, const std::vector<Detection>& detections, size_t index,
                 ObservedObject* object) {
  const int side = object->target.side;
  object->target.covered.assign(static_cast<size_t>(side) * side, 0);
  const double step = 2.0 * object->half / side;
  for (size_t k = 0; k < detections.size(); ++k) {
    const Detection& other = detections[k];
    if (k == index || !MayStandBefore(other, detections[index])) continue;
    Eigen::AlignedBox2d near = other.box;
    near.min().array() -= kTouching;
    near.max().array() += kTouching;
    if (near.intersects(object->box)) object->hidden = true;
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double px = object->centre.x() - object->half + (x + 0.5) * step;
      const double py = object->centre.y() - object->half + (y + 0.5) * step;
      std::uint8_t& covered = object->target.covered[static_cast<size_t>(y) * side + x];
      if (px < 0.0 || py < 0.0 || px >= photo.width || py >= photo.height) {
        covered = 1;
        continue;
      }
      for (size_t k = 0; k < detections.size() && covered == 0; ++k) {
        if (k == index || !MayStandBefore(detections[k], detections[index])) continue;
        const std::uint8_t alpha =
            *detections[k].alpha.At(static_cast<int>(px), static_cast<int>(py));
        covered = alpha >= kVisible ? 1 : 0;
      }
    }
  }
}

}  // namespace

core::Camera ObservedObject::CropCamera(const core::Camera& camera) const {
  core::Camera crop = camera;
  const double scale = target.side / (2.0 * half);
  crop.cx = (camera.cx - centre.x() + half) * scale;
  crop.cy = (camera.cy - centre.y() + half) * scale;
  crop.fx = camera.fx * scale;
  crop.fy = camera.fy * scale;
  crop.width = crop.height = target.side;
  return crop;
}

std::vector<ObservedObject> ObserveObjects(const core::Image& photo,
                                           const std::vector<Detection>& detections, int side) {
  std::vector<ObservedObject> objects;
  for (size_t k = 0; k < detections.size(); ++k) {
    ObservedObject object;
    object.box = detections[k].box;
    const library_fit::FitPhoto whole = library_fit::FitPhotoOf(photo, detections[k].alpha);
    object.prior_crop = asset_lift::CropImage(photo, detections[k].alpha, whole.frame);
    asset_lift::ViewFrame frame = whole.frame;
    frame.half *= kFitMargin / library_fit::kPriorMargin;
    object.centre = {frame.center_x, frame.center_y};
    object.half = frame.half;
    object.target =
        library_fit::MakeFitTarget(asset_lift::CropView(photo, detections[k].alpha, frame, side));
    object.hidden = detections[k].cut;
    MarkCovered(photo, detections, k, &object);
    objects.push_back(std::move(object));
  }
  return objects;
}

}  // namespace simwright::twin
