#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "asset_lift/priors/shape_prior.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// The initial shape of a fit.
struct InitialShape {
  // The log odds that a world point lies inside; about +-4 where the shape is certain.
  std::function<double(const Eigen::Vector3d&)> odds;
  core::TriangleMesh surface;  // closed
  Eigen::AlignedBox3d box;     // world AABB of the surface
};

// Converts a learned prediction. Throws core::Error where the prediction is empty.
InitialShape InitialShapeFrom(const ShapePrediction& prediction);

// Converts a closed mesh: the log odds follow the signed distance and reach 4 at 1/40 of the
// diagonal.
InitialShape InitialShapeFrom(const core::TriangleMesh& mesh);

// Adds the parts of the matte that the shape leaves uncovered (outline/missing_parts.h): a prior
// that sees 64 pixels a side drops handles and knobs. Returns the shape unchanged where nothing is
// missing.
InitialShape WithMissingParts(InitialShape shape, const Matte& matte, const core::Camera& camera);

// Returns an ellipsoid that fills the silhouette: the initial shape without prior knowledge.
// `frame` locates the silhouette.
InitialShape InitialEllipsoid(const ViewFrame& frame, const Eigen::Vector2d& half_axes_uv);

}  // namespace simwright::asset_lift
