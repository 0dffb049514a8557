#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "asset_lift/elevation.h"
#include "asset_lift/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

enum class ShapeForm {
  kUpright,  // turned about the vertical, with what sticks out (a handle) inflated
  kLying,    // turned about an axis in the picture plane
  kInflated  // smooth inflation of the outline
};

const char* Name(ShapeForm form);  // "turned upright", "turned lying", "inflated"

struct InflationOptions {
  int resolution = 104;             // grid cells along the longest side of the first mesh
  double revolved_coverage = 0.78;  // of the outline that a turned body must explain, with a prior
  double plain_coverage = 0.955;    // ... and without one
  double wall_ratio = 0.05;         // of the width: a vessel's wall
  double foot_ratio = 0.025;        // of the height: cut off so that it stands; half a fruit's dent
  double foot_angle = 0.12;  // rad of tilt that the foot has to bear; it grows 2.25 times at most
  int face_budget = 12000;   // of the mesh handed on
};

// A closed first mesh in the world (z up, the camera's units), and how well it fits.
struct InflatedShape {
  core::TriangleMesh mesh;
  ShapeForm form = ShapeForm::kInflated;
  Eigen::Hyperplane<double, 3> mirror;  // the back mirrors the front across it
  double silhouette_iou = 0.0;          // with the matte, from the camera
};

// The camera that took the photo, with the object's middle at the origin, one unit away from it.
// `elevation` (rad) is that of the sight line to the object; `focal` in pixels.
core::Camera PhotoCamera(const Matte& matte, double focal, double elevation);

// Inflates the matte's outline: a body of revolution where the outline is symmetric about an axis,
// upright or in the picture plane, else depth from a Poisson equation over the outline. Holes in
// the outline become holes of the mesh; a vessel seen from above is hollowed to its wall.
// Returns the better form by its silhouette. Throws core::Error where nothing can be inflated.
InflatedShape InflateOutline(const Matte& matte, const core::Camera& camera,
                             const CategoryPrior& prior, const InflationOptions& options = {});

// The estimate narrowed by the outline of a thing turned on a wheel: from too high an elevation the
// discs of its body no longer fit into the outline's lower corners, from too low a one the body
// ends in a point instead of a foot. Both count beside the estimate's own deviation.
ElevationEstimate RefineElevation(const Matte& matte, double focal,
                                  const ElevationEstimate& estimate);

// Intersection over union of a mesh's silhouette with the matte, from the camera.
double SilhouetteIou(const core::TriangleMesh& mesh, const core::Camera& camera,
                     const Matte& matte);

}  // namespace simwright::asset_lift
