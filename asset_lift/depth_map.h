#pragma once

#include <opencv2/core.hpp>

namespace simwright::asset_lift {

// Squared half depth over an outline, pixels^2 (CV_32F): positive inside, zero on the edge, and
// falling outside, so that its zero level is the outline to a fraction of a pixel.

// Solution of the Poisson equation Laplace(u) = -c with u = 0 on the edge: a disc becomes a ball
// (c = 4); c falls to 2 for a long strip, whose half width then is its half depth.
cv::Mat PoissonDepth(const cv::Mat& mask);

// Depth of a body turned about the line through `center` with direction `axis` (unit) in the
// picture: r(s)^2 - t^2 with r the outline's half width at s along the axis.
cv::Mat LyingDepth(const cv::Mat& mask, const cv::Point2d& center, const cv::Point2d& axis);

// The axis about which the mask is most nearly its own mirror image: direction (unit) and the
// share of the mask that the mirror image covers, in [0, 1]. The axis runs through the centroid.
struct MirrorAxis {
  cv::Point2d center, direction;
  double agreement = 0.0;
};
MirrorAxis FindMirrorAxis(const cv::Mat& mask);

// Signed distance to the mask's edge, pixels, positive inside (CV_32F).
cv::Mat SignedEdgeDistance(const cv::Mat& mask);

}  // namespace simwright::asset_lift
