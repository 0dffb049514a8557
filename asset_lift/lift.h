#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "asset_lift/camera/elevation.h"
#include "asset_lift/mesh_fit/shape_fit_options.h"
#include "asset_lift/outline/inflation.h"
#include "asset_lift/priors/score_distillation_options.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

class ShapePrior;
class ViewPrior;

// The learned priors of a reconstruction; each may be null. They are shared because loading takes
// longer than a crop's inference.
struct LiftPriors {
  std::shared_ptr<const ShapePrior> shape;  // the initial shape and the hidden side's colours
  std::shared_ptr<ViewPrior> view;          // the score model of score distillation
};

// The amount of work spent on the shape.
enum class LiftEffort {
  kOutline,  // the inflated silhouette, unrefined: a few seconds, no learned prior
  kFast,     // the initial shape, refined as a mesh: under a minute
  kFull      // a radiance field started from the initial shape, then the mesh stage
};

struct LiftOptions {
  LiftEffort effort = LiftEffort::kFull;
  ShapeFitOptions fit;
  // Score distillation of the two stages. Its weights are in `fit`, by default 0, because our own
  // view prior makes shapes worse; ConfigureForPublishedViewPrior sets them.
  ScoreDistillationOptions field_distillation, mesh_distillation;
  int fit_side = 128;  // pixels per side of the crop that the stages fit

  std::optional<core::Image> mask;  // the object's mask, with the photo's aspect ratio
  double elevation = -1.0;          // rad; negative: estimated
  // The field of view over the photo's longer side, rad; 0: from `focal_35mm`, otherwise the
  // default.
  double field_of_view = 0.0;
  double focal_35mm = 0.0;  // 35 mm-equivalent focal length, mm; 0: unknown
  // A photo of one object is mostly cropped or taken from a distance: its field of view is narrower
  // than a lens's.
  double default_field_of_view = 0.61;  // rad, 35 degrees
  int texture_size = 1024;              // pixels per side
  // Divides the photo's shading out before it becomes the texture (texture/delighting.h).
  bool delight = false;
  int max_side = 1024;  // a larger photo is scaled down first
  std::uint64_t seed = 1;
  SegmentationOptions segmentation;
  InflationOptions inflation;

  LiftOptions();
};

// Sets score distillation to the published weights, guidance and noise (Zero-1-to-3 in threestudio;
// the mesh stage's noise is that of its second stage), and reduces the weight of the initial shape:
// for a view prior trained at their size. All other options are unchanged.
void ConfigureForPublishedViewPrior(LiftOptions* options);

// A photo's object as a textured, closed mesh in the world frame: z up, the camera on the side of
// -y, arbitrary scale (the camera one unit away).
struct LiftedMesh {
  core::TexturedMesh mesh;
  core::Camera camera;  // of the photo as used (scaled down)
  core::Image photo;    // as used
  Matte matte;
  ElevationEstimate elevation;
  ShapeForm form = ShapeForm::kInflated;  // of the silhouette
  std::string start;                      // a description of the initial shape
  double silhouette_iou = 0.0;
  core::Findings findings;
};

// Reconstructs the photo's object: segments it, estimates the camera, predicts the initial shape,
// fits it and textures it, the front from the photo and the hidden side from the priors. A solid of
// revolution keeps the shape revolved from its silhouette, and so does every object where no
// learned prior is given. Throws core::Error with the reason where no single object stands out, and
// core::Cancelled.
LiftedMesh LiftPhoto(const core::Image& photo, const CategoryPrior& prior, const LiftPriors& priors,
                     const LiftOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
