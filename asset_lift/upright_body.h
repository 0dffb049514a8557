#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "asset_lift/elevation.h"
#include "core/camera.h"

namespace simwright::asset_lift {

// A body of revolution about a vertical line in the world, as wide as an outline allows.
struct UprightBody {
  double axis_x = 0.0, axis_y = 0.0;  // world
  double bottom = 0.0, step = 0.0;    // world z of the first level, distance of levels
  std::vector<double> radius;         // by level; 0 where there is nothing
  double coverage = 0.0;              // share of the mask that the body's silhouette covers

  double RadiusAt(double z) const;  // linear between levels, 0 outside
  double top() const { return bottom + step * static_cast<double>(radius.size() - 1); }
  double MaxRadius() const;
};

// At each height the largest disc about the axis whose picture stays inside the mask: the least
// distance, in that plane, from the axis to the sight lines through the outline's background
// pixels. The picture of a body of revolution is the union of its discs' pictures, so this is the
// largest such body inside the outline, exact in perspective. Levels at either end that add
// nothing to the silhouette are cut: a cylinder keeps its flat base and rim.
// The axis stands in the plane y = 0, where the coverage is best, and then, where that covers as
// much, in the middle of the mask's rows: a handle on one side does not draw it along. `mask` is
// CV_8U, of the camera's size.
UprightBody FitUprightBody(const cv::Mat& mask, const core::Camera& camera);

// Gives the body of an open vessel its rim back: where the discs shrink within the uppermost sixth,
// which a camera that looks down a little less than was estimated makes of every rim, the wall below
// goes on straight instead, up to where the rim's picture reaches the top of the mask. The body keeps
// its levels. True where there was such a shoulder.
bool SharpenRim(const cv::Mat& mask, const core::Camera& camera, UprightBody* body);

// CV_8U mask of the body's silhouette.
cv::Mat Silhouette(const UprightBody& body, const core::Camera& camera);

}  // namespace simwright::asset_lift
