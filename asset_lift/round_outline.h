#pragma once

#include <optional>

#include <opencv2/core.hpp>

namespace simwright::asset_lift {

// The ellipse (axes within 4:3 of each other) that best explains a round thing of which `mask`
// (CV_8U) shows a part: its rim lies on the mask's outline or on edges of `bgr` that run along it,
// all round, and it covers the mask. None where less than `support` of its rim does.
// Deterministic for a seed. Least squares on random arcs of the outline (as RANSAC, Fischler and
// Bolles 1981).
std::optional<cv::RotatedRect> FindRoundOutline(const cv::Mat& bgr, const cv::Mat& mask,
                                                std::uint64_t seed, double support = 0.45);

}  // namespace simwright::asset_lift
