#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/priors/image_objective.h"
#include "asset_lift/radiance_field/field_fit_options.h"
#include "asset_lift/radiance_field/occupancy_grid.h"
#include "asset_lift/radiance_field/radiance_field.h"
#include "asset_lift/radiance_field/volume_rendering.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

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
