#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace simwright::asset_lift {

// Returns the ellipse (axis ratio at most 4:3) that best explains a round object of which `mask`
// (CV_8U) shows a part: its rim lies on the mask's outline or on edges of `bgr` parallel to it,
// over the whole circumference, and it covers the mask. Returns none where less than `support` of
// its rim does. Deterministic for a seed. Least squares on random arcs of the outline (as RANSAC,
// Fischler and Bolles 1981).
std::optional<cv::RotatedRect> FitEllipseOutline(const cv::Mat& bgr, const cv::Mat& mask,
                                                 std::uint64_t seed, double support = 0.45);

}  // namespace simwright::asset_lift
