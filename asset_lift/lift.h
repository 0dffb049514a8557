#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "asset_lift/elevation.h"
#include "asset_lift/inflation.h"
#include "asset_lift/score_distillation.h"
#include "asset_lift/segmentation.h"
#include "asset_lift/shape_fit.h"
#include "core/camera.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

class ShapePrior;
class ViewPrior;

// The learned parts of a lift; each may be null. Shared: loading takes longer than a crop.
struct LiftPriors {
  std::shared_ptr<const ShapePrior> shape;  // the first guess, and the hidden side's colours
  std::shared_ptr<ViewPrior> view;          // what score distillation asks
};

// How much is done to find the shape.
enum class LiftEffort {
  kOutline,  // the inflated outline as it is: a few seconds, no learned prior
  kFast,     // the first guess, refined as a mesh: under a minute
  kFull      // a radiance field about the first guess, then the mesh stage
};

struct LiftOptions {
  LiftEffort effort = LiftEffort::kFull;
  ShapeFitOptions fit;
  // Score distillation of either stage: gentle, as suits our own view prior; TrustViewPrior changes
  // that.
  ScoreDistillationOptions field_distillation, mesh_distillation;
  int fit_side = 128;  // pixels a side of the crop that the stages fit

  std::optional<core::Image> mask;  // the object's mask, of the photo's proportions
  double elevation = -1.0;          // rad; negative: estimated
  // Field of view over the photo's longer side, rad; 0: from `focal_35mm`, else the default.
  double field_of_view = 0.0;
  double focal_35mm = 0.0;  // 35 mm-equivalent focal length, mm; 0: unknown
  // A picture of one thing is mostly a crop or taken from a few steps away: narrower than a lens.
  double default_field_of_view = 0.61;  // rad, 35 degrees
  int texture_size = 1024;              // pixels a side
  int max_side = 1024;                  // a larger photo is scaled down first
  std::uint64_t seed = 1;
  SegmentationOptions segmentation;
  InflationOptions inflation;

  LiftOptions();
};

// Score distillation with the published weights, guidance and noise (Zero-1-to-3 in threestudio;
// the mesh stage's noise is that of its second stage), and a first guess that gives way: for a view
// prior that was trained at their size. Leaves everything else as it is.
void TrustViewPrior(LiftOptions* options);

// A photo's object as a textured, closed mesh. In the world: z up, the camera on the side of -y,
// arbitrary scale (the camera one unit away).
struct LiftedMesh {
  core::TexturedMesh mesh;
  core::Camera camera;  // of the photo as it was used (scaled down)
  core::Image photo;    // as it was used
  Matte matte;
  ElevationEstimate elevation;
  ShapeForm form = ShapeForm::kInflated;  // of the outline
  std::string start;                      // what the fit started from, in words
  double silhouette_iou = 0.0;
  core::Findings findings;
};

// Segments, estimates the camera, guesses the shape, fits it and textures it: the front from the
// photo, the hidden side from the priors. What is turned on a wheel stays as its outline turned,
// and so does everything where nothing learned is given. Throws core::Error with the reason where
// no single object stands out, and core::Cancelled.
LiftedMesh LiftPhoto(const core::Image& photo, const CategoryPrior& prior, const LiftPriors& priors,
                     const LiftOptions& options, core::Progress* progress);

}  // namespace simwright::asset_lift
