#pragma once

#include <opencv2/core.hpp>

#include "asset_lift/outline/outline_field.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// Returns the pixels that the object covers by half or more (CV_8U, 255).
cv::Mat MaskOfMatte(const Matte& matte);

// Returns the part of a mask (CV_8U) that a body's silhouette does not cover, without specks: a
// handle, a spout, a rim that is not quite round. It is dilated into the body by 7 % of `width`
// (pixels, of the object), so that the parts join.
cv::Mat UncoveredParts(const cv::Mat& mask, const cv::Mat& body, double width);

// Returns the parts of the matte that a mesh (world) leaves uncovered from the camera as inflated
// bodies, each at the depth of the mesh's outline beside it; empty where nothing is missing.
OutlineField MissingParts(const core::TriangleMesh& mesh, const Matte& matte,
                          const core::Camera& camera);

}  // namespace simwright::asset_lift
