#pragma once

#include <string>
#include <vector>

#include "asset_lift/segmentation/segmentation.h"

namespace simwright::asset_lift {

// The prior knowledge about the object in the photo.
struct CategoryPrior {
  double length_min = 0.1, length_max = 0.1;  // m, longer side on the ground
  double width_min = 0.1, width_max = 0.1;    // m
  double height_min = 0.1, height_max = 0.1;  // m
  bool round = false;                         // a ball or a fruit: no flat base, no rim
  bool revolved = false;                      // a solid of revolution: round from above
  bool open = false;                          // a vessel with an open top
  bool flat = false;                          // lies flat: people photograph it from above
  bool angular = false;                       // a box, or made of boxes
};

struct ElevationEstimate {
  double elevation = 0.35;  // rad, of the sight line to the object above the horizon
  double deviation = 0.2;   // rad, one standard deviation of the posterior
  std::string sentence;     // the estimate and its decisive cues, to follow "elevation"
};

// Returns the camera's elevation above the object as the mean of a posterior over 0 to 80 degrees.
// The posterior combines the photographer's habit (a normal distribution about 22 degrees, 38 for
// flat objects), the silhouette's aspect ratio against the category's sizes (the yaw is unknown and
// integrated by fixed quasi-random samples), and for objects with a round body the curves of the
// base's front and the rim's back: a circle seen from elevation e has half axes in the ratio 1 :
// sin e.
ElevationEstimate EstimateElevation(const Matte& matte, const CategoryPrior& prior);

// Fuses two independent estimates into their precision-weighted mean. A disagreement between them
// increases the deviation.
ElevationEstimate Combined(const ElevationEstimate& a, const ElevationEstimate& b);

// Returns the ratio b / a in [0, 1] of the half axes of the ellipse that fits the middle of the
// silhouette's lower (or upper) end. Negative where that end is not an elliptical arc.
double EndArcRatio(const Matte& matte, bool lower_end);

}  // namespace simwright::asset_lift
