#pragma once

#include <string>
#include <vector>

#include "asset_lift/segmentation.h"

namespace simwright::asset_lift {

// What is known beforehand of the thing in the photo.
struct CategoryPrior {
  double length_min = 0.1, length_max = 0.1;  // m, longer side on the ground
  double width_min = 0.1, width_max = 0.1;    // m
  double height_min = 0.1, height_max = 0.1;  // m
  bool round = false;                         // a ball or a fruit: no flat base, no rim
  bool revolved = false;                      // turned on a wheel: round from above
  bool open = false;                          // a vessel one can look into
  bool flat = false;                          // lies flat: people photograph it from above
  bool angular = false;                       // a box, or made of boxes
};

struct ElevationEstimate {
  double elevation = 0.35;  // rad, of the sight line to the object above the horizon
  double deviation = 0.2;   // rad, one standard deviation of the posterior
  std::string sentence;     // the figure and which cues decided, to follow "elevation"
};

// How high above the object the photo was taken, as the mean of a posterior over 0 to 80 degrees:
// the photographer's habit (a normal distribution about 22 degrees, 38 for flat things), the
// outline's height over its width against the category's sizes (yaw unknown, integrated by fixed
// quasi-random draws), and for round-bodied things the curves of the base's front and the rim's
// back: of a circle seen from elevation e the half axes are as 1 : sin e.
ElevationEstimate EstimateElevation(const Matte& matte, const CategoryPrior& prior);

// Two independent readings as one: their mean by precision. What they disagree by adds to its
// deviation.
ElevationEstimate Combined(const ElevationEstimate& a, const ElevationEstimate& b);

// Half axes' ratio b / a in [0, 1] of the ellipse that the lower (or upper) end of the outline
// follows over its middle; negative where the end is not such an arc.
double EndArcRatio(const Matte& matte, bool lower_end);

}  // namespace simwright::asset_lift
