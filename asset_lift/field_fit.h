#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/field_losses.h"
#include "asset_lift/observed_view.h"
#include "asset_lift/occupancy_grid.h"
#include "asset_lift/picture_objective.h"
#include "asset_lift/radiance_field.h"
#include "asset_lift/volume_rendering.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::asset_lift {

// A part of the fit, on observed views of one size.
struct FieldFitStage {
  int steps = 0;
  int view_side = 0;  // pixels of a view's longer side at most
};

struct FieldFitOptions {
  // The cube in which the object lies, and the field's sizes.
  RadianceFieldOptions field;
  // The published schedule (600 steps; 128, 256, 512 pixels) shrunk to two cores.
  std::vector<FieldFitStage> stages = {{200, 64}, {100, 128}};
  // Rays of observed views a step: one view of 64 pixels, or random patches of more.
  int rays_per_step = 4096;
  // Adam's rate, falling geometrically to the last. The published 0.01 is for 600 steps: in 200,
  // a chair from 8 views reaches a volume IoU of 0.46 with it and of 0.54 with these.
  double rate = 0.02;
  double last_rate = 0.004;
  FieldLossWeights weights;
  VolumeRenderOptions render;
  OccupancyOptions occupancy;
  int occupancy_interval = 16;  // steps from an update of the occupancy grid to the next
  // Space that projects beside a mask is ruled out from the start: what the masks say need not be
  // learned, and rays through nothing cost nothing.
  bool carve = true;
  // Where there is no objective, a picture of so many pixels a side from a random direction takes
  // the shape's losses each step, as the objective's pictures do; 0: none.
  int shape_picture_side = 48;
  double carve_margin = 1.0;  // pixels at the last stage's size, for masks that are a little small
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct FieldFit {
  RadianceField field;
  OccupancyGrid occupancy;     // what is ruled out, and what the fit left empty
  std::vector<double> losses;  // a value a step done: all terms together
  double color_error = 0.0;    // root mean square over the last steps' rays, sRGB over black
  core::Findings findings;     // field_carving.h's; "field-fit-unstable"
};

// A radiance field that shows what the views show and, between them, what `objective` (may be null)
// asks for: each step draws rays of the views and one picture from the objective's next camera.
// Space that no mask allows stays empty. Where a loss or a gradient is not finite, the fit goes
// back to its last good parameters and halves the rate; the third time it stops there and says so
// in the findings. Views that the others contradict are named and left out. Throws core::Error for
// views or options that are not valid, or an objective whose gradient does not fit its picture;
// core::Cancelled.
FieldFit FitField(const std::vector<ObservedView>& views, PictureObjective* objective,
                  const FieldFitOptions& options, core::Progress* progress);

// The field as `camera` sees it; normals (H x W x 3, world) where `normals` is not null.
ObjectPicture DrawField(const FieldFit& fit, const core::Camera& camera,
                        core::FloatImage* normals = nullptr);

}  // namespace simwright::asset_lift
