#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/priors/image_objective.h"
#include "asset_lift/radiance_field/field_losses.h"
#include "asset_lift/radiance_field/occupancy_grid.h"
#include "asset_lift/radiance_field/radiance_field.h"
#include "asset_lift/radiance_field/volume_rendering.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

// A stage of the fit, on observed views of one size.
struct FieldFitStage {
  int steps = 0;
  int view_side = 0;  // maximum pixels of a view's longer side
};

struct FieldFitOptions {
  // The cube that contains the object, and the field's sizes.
  RadianceFieldOptions field;
  // The published schedule (600 steps; 128, 256, 512 pixels) reduced for two cores.
  std::vector<FieldFitStage> stages = {{200, 64}, {100, 128}};
  // Rays of observed views per step: one view of 64 pixels, or random patches of larger views.
  int rays_per_step = 4096;
  // Adam's learning rate, which decays geometrically to `last_rate`. The published 0.01 is for 600
  // steps and gives a lower volume IoU in 200.
  double rate = 0.02;
  double last_rate = 0.004;
  FieldLossWeights weights;
  VolumeRenderOptions render;
  OccupancyOptions occupancy;
  int occupancy_interval = 16;  // steps between updates of the occupancy grid
  // True if space that projects outside a mask is excluded from the start, so that the fit need not
  // learn the masks and rays through empty space cost nothing.
  bool carve = true;
  // The side in pixels of a random image that takes the shape losses each step where there is no
  // objective, as the objective's images do. 0: none.
  int shape_picture_side = 48;
  double carve_margin = 1.0;  // pixels at the last stage's size, for masks that are slightly too
                              // small
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct FieldFit {
  RadianceField field;
  OccupancyGrid occupancy;     // cells that are excluded or that the fit left empty
  std::vector<double> losses;  // the total loss of each step
  double color_error = 0.0;    // RMS over the last steps' rays, sRGB over black
  core::Findings findings;     // field_carving.h's; "field-fit-unstable"
};

// Fits a radiance field to the views, regularized between them by `objective` (may be null). Each
// step samples rays of the views and renders one image from the objective's next camera. Space
// outside every mask stays empty. Where a loss or a gradient is not finite, the fit returns to its
// last finite parameters and halves the rate; the third time it stops and reports this in the
// findings. Views that contradict the others are excluded and named in the findings. Throws
// core::Error for invalid views or options, or an objective whose gradient does not match its
// image; core::Cancelled.
FieldFit FitField(const std::vector<ObservedView>& views, ImageObjective* objective,
                  const FieldFitOptions& options, core::Progress* progress);

// Renders the field from `camera`. Writes normals (H x W x 3, world) where `normals` is not null.
ObjectImage RenderField(const FieldFit& fit, const core::Camera& camera,
                        core::FloatImage* normals = nullptr);

}  // namespace simwright::asset_lift
