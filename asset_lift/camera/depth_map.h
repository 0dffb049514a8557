#pragma once

#include <opencv2/core.hpp>

namespace simwright::asset_lift {

// The depth maps below are squared half depths over a mask, pixels^2 (CV_32F): positive inside,
// zero on the edge and falling outside, so that the zero level set is the silhouette with subpixel
// accuracy.

// Returns the solution of the Poisson equation Laplace(u) = -c with u = 0 on the edge. A disc
// becomes a ball (c = 4); c falls to 2 for a long strip, whose half depth then equals its half
// width.
cv::Mat PoissonDepth(const cv::Mat& mask);

// Returns the squared half depth of a solid of revolution about the line through `center` with unit
// direction `axis` in the image plane: r(s)^2 - t^2, with r the silhouette's half width at s along
// the axis.
cv::Mat RevolvedDepth(const cv::Mat& mask, const cv::Point2d& center, const cv::Point2d& axis);

// The axis of best mirror symmetry of a mask. The axis runs through the centroid; `direction` is a
// unit vector, and `agreement` in [0, 1] is the share of the mask that its mirror image covers.
struct MirrorAxis {
  cv::Point2d center, direction;
  double agreement = 0.0;
};
MirrorAxis FindMirrorAxis(const cv::Mat& mask);

// Returns the signed distance to the mask's edge, pixels, positive inside (CV_32F).
cv::Mat SignedEdgeDistance(const cv::Mat& mask);

}  // namespace simwright::asset_lift
