#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "asset_lift/camera/elevation.h"
#include "core/camera.h"

namespace simwright::asset_lift {

// A solid of revolution about a vertical line in the world, as wide as a mask permits.
struct UprightBody {
  double axis_x = 0.0, axis_y = 0.0;  // world
  double bottom = 0.0, step = 0.0;    // world z of the first level, spacing of levels
  std::vector<double> radius;         // per level; 0 where the body is empty
  double coverage = 0.0;              // share of the mask covered by the body's silhouette

  double RadiusAt(double z) const;  // linear between levels, 0 outside
  double top() const { return bottom + step * static_cast<double>(radius.size() - 1); }
  double MaxRadius() const;
};

// Fits the largest solid of revolution inside the mask. At each height it takes the largest disc
// about the axis whose image stays inside the mask: its radius is the minimum distance, in that
// plane, from the axis to the sight lines through the background pixels. The silhouette of a solid
// of revolution is the union of its discs' images, so the fit is exact under perspective. Levels at
// either end that add nothing to the silhouette are cut: a cylinder keeps its flat base and rim.
// The axis lies in the plane y = 0, where the coverage is highest, and among equal coverages in the
// middle of the mask's rows, so that a handle on one side does not shift it. `mask` is CV_8U with
// the camera's image size.
UprightBody FitUprightBody(const cv::Mat& mask, const core::Camera& camera);

// Restores the rim of an open vessel. A camera that looks down slightly less than estimated makes
// the discs shrink within the uppermost sixth of the body; the wall below is extended straight
// instead, up to where the rim's image reaches the top of the mask. The body keeps its levels.
// Returns true if there was such a shoulder.
bool RestoreRim(const cv::Mat& mask, const core::Camera& camera, UprightBody* body);

// The line through a body's radii between its foot and its rim.
struct WallLine {
  double taper = 0.0;      // the radius gained over the height, over the mean radius
  double deviation = 0.0;  // root mean square, over the mean radius
};
// Requires a body with at least 12 levels.
WallLine FitWallLine(const UprightBody& body);

// Returns the CV_8U mask of the body's silhouette.
cv::Mat Silhouette(const UprightBody& body, const core::Camera& camera);

}  // namespace simwright::asset_lift
