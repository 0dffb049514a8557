#include "asset_lift/lift.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "texture/photo_projection.h"

namespace simwright::asset_lift {
namespace {

core::Image ScaledDown(const core::Image& photo, int max_side) {
  const int longer = std::max(photo.width, photo.height);
  if (longer <= max_side) return photo;
  const double scale = static_cast<double>(max_side) / longer;
  return core::Resize(photo, std::max(1, static_cast<int>(std::lround(photo.width * scale))),
                      std::max(1, static_cast<int>(std::lround(photo.height * scale))));
}

// Focal length in pixels of `photo`, and where it comes from.
double FocalLength(const core::Image& photo, const LiftOptions& options, std::string* sentence) {
  const double longer = std::max(photo.width, photo.height);
  double fov = options.field_of_view;
  *sentence = "given";
  if (fov <= 0.0 && options.focal_35mm > 0.0) {
    fov = 2.0 * std::atan(18.0 / options.focal_35mm);  // half of 36 mm over the focal length
    *sentence = "from EXIF";
  }
  if (fov <= 0.0) {
    fov = options.default_field_of_view;
    *sentence = "assumed";
  }
  if (!(fov > 0.02 && fov < 2.8)) {
    throw core::Error("a field of view lies between 1 and 160 degrees", "", "mend --fov");
  }
  char text[64];
  std::snprintf(text, sizeof(text), "field of view %.0f degrees, %s", fov * 180.0 / M_PI,
                sentence->c_str());
  *sentence = text;
  return 0.5 * longer / std::tan(0.5 * fov);
}

// Photos under 200 pixels give a staircase for an outline: drawn larger, smoothly.
Matte Enlarged(const Matte& matte, int factor) {
  if (factor == 1) return matte;
  Matte larger = matte;
  larger.alpha = core::Resize(matte.alpha, matte.alpha.width * factor, matte.alpha.height * factor);
  larger.left *= factor;
  larger.top *= factor;
  larger.right *= factor;
  larger.bottom *= factor;
  return larger;
}

}  // namespace

LiftedMesh LiftPhoto(const core::Image& photo, const CategoryPrior& prior,
                     const LiftOptions& options, core::Progress* progress) {
  LiftedMesh lifted;
  progress->Stage("segmentation");
  lifted.photo = ScaledDown(photo, options.max_side);
  SegmentationOptions segmentation = options.segmentation;
  segmentation.seed = options.seed;
  segmentation.round_object = prior.round;
  lifted.matte = SegmentObject(lifted.photo, options.mask, segmentation);
  const int longer = std::max(lifted.photo.width, lifted.photo.height);
  if (const int factor = longer < 200 ? 3 : 1; factor > 1) {
    lifted.photo =
        core::Resize(lifted.photo, lifted.photo.width * factor, lifted.photo.height * factor);
    lifted.matte = Enlarged(lifted.matte, factor);
  }
  std::string camera_sentence;
  const double focal = FocalLength(lifted.photo, options, &camera_sentence);
  lifted.elevation = EstimateElevation(lifted.matte, prior);
  if (options.elevation >= 0.0) {
    lifted.elevation = {options.elevation, 0.0, "elevation given"};
  } else if (prior.revolved && !prior.round) {
    lifted.elevation = RefineElevation(lifted.matte, focal, lifted.elevation);
  }
  // Level sight lines never cross the planes in which a turned body's discs lie.
  const double elevation = std::clamp(lifted.elevation.elevation, 0.03, 1.5);
  lifted.camera = PhotoCamera(lifted.matte, focal, elevation);
  progress->Stage("shape");
  const InflatedShape shape = InflateOutline(lifted.matte, lifted.camera, prior, options.inflation);
  lifted.form = shape.form;
  lifted.silhouette_iou = shape.silhouette_iou;
  progress->Stage("texture");
  texture::ProjectionOptions projection;
  projection.texture_size = options.texture_size;
  lifted.mesh = texture::ProjectPhoto(shape.mesh, lifted.camera, lifted.photo, lifted.matte.alpha,
                                      shape.mirror, projection);
  progress->Finish();
  const auto tell = [&](const std::string& code, const std::string& sentence, double figure) {
    lifted.findings.push_back({code, core::Severity::kInfo, "", sentence, figure});
  };
  tell("segmentation", "the object was cut out by " + lifted.matte.method, lifted.matte.area);
  tell("camera", camera_sentence, focal);
  tell("elevation", lifted.elevation.sentence, elevation);
  tell("shape", std::string("the shape is ") + Name(shape.form), shape.silhouette_iou);
  return lifted;
}

}  // namespace simwright::asset_lift
