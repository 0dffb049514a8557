#pragma once

#include <vector>

#include "texture/shading_fit.h"

namespace simwright::texture {

// Replaces highlights in the albedo (K, linear RGB) of an object's pixels: those that are brighter
// and less saturated than the median of the albedo about them, in regions that fade out at their
// border, as print does not, and whose normals reflect the brighter side of the light to `viewer`
// (world). Returns which pixels were replaced.
std::vector<char> ReplaceHighlights(const ObjectPixels& pixels,
                                    const Eigen::Matrix<float, 9, 1>& light,
                                    const Eigen::Vector3f& viewer,
                                    std::vector<Eigen::Vector3f>* albedo);

}  // namespace simwright::texture
