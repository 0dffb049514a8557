#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>

#include "asset_lift/shape_prior.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// What is known of the shape before a fit begins.
struct FirstGuess {
  // Log odds that a world point lies inside; about +-4 where it is sure.
  std::function<double(const Eigen::Vector3d&)> odds;
  core::TriangleMesh surface;  // closed
  Eigen::AlignedBox3d box;     // world: holds the surface
};

// The learned prediction. Throws core::Error where it sees nothing.
FirstGuess GuessFrom(const ShapePrediction& prediction);

// A closed mesh: odds by the signed distance to it, 4 at a fortieth of its diagonal.
FirstGuess GuessFrom(const core::TriangleMesh& mesh);

// An ellipsoid that fills the outline: what a fit starts from when nothing is known. `frame` says
// where the outline lies.
FirstGuess EllipsoidGuess(const ViewFrame& frame, const Eigen::Vector2d& half_axes_uv);

}  // namespace simwright::asset_lift
