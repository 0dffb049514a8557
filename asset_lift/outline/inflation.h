#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "asset_lift/camera/elevation.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

enum class ShapeForm {
  kUpright,  // solid of revolution about the vertical, with protrusions (a handle) inflated
  kLying,    // solid of revolution about an axis in the image plane
  kInflated  // smooth inflation of the silhouette
};

const char* Name(ShapeForm form);  // "revolved upright", "revolved lying", "inflated"

struct InflationOptions {
  int resolution = 104;             // grid cells along the longest side of the initial mesh
  double revolved_coverage = 0.78;  // silhouette share that a solid of revolution must cover, with
                                    // a prior
  double plain_coverage = 0.955;    // ... and without one
  double wall_ratio = 0.05;         // of the width: a vessel's wall thickness
  double base_cut_ratio = 0.032;    // of the height: cut off to make a flat base; shallower than a
                                    // fruit's dimple
  double base_tilt_angle =
      0.12;                 // rad of tilt that the base must support; it grows 2.25 times at most
  int face_budget = 12000;  // of the returned mesh
};

// A closed initial mesh in the world frame (z up, the camera's units), and its fit quality.
struct InflatedShape {
  core::TriangleMesh mesh;
  ShapeForm form = ShapeForm::kInflated;
  Eigen::Hyperplane<double, 3> mirror;  // the symmetry plane between front and back
  double silhouette_iou = 0.0;          // with the matte, from the camera
};

// Returns the photo's camera, with the object's centre at the origin, one unit away. `elevation`
// (rad) is that of the line of sight to the object; `focal` is in pixels.
core::Camera PhotoCamera(const Matte& matte, double focal, double elevation);

// Inflates the matte's silhouette: a solid of revolution where the silhouette is symmetric about an
// axis, upright or in the image plane, otherwise depth from a Poisson equation over the silhouette.
// Holes in the silhouette become holes of the mesh; a vessel seen from above is hollowed to its
// wall. Returns the candidate with the higher silhouette IoU. Throws core::Error where inflation
// fails.
InflatedShape InflateOutline(const Matte& matte, const core::Camera& camera,
                             const CategoryPrior& prior, const InflationOptions& options = {});

// Refines the estimate by the silhouette of a solid of revolution: if the assumed elevation is too
// high, the discs of its body no longer fit into the silhouette's lower corners; if it is too low,
// the body ends in a point instead of a base. Both terms are weighed with the estimate's own
// deviation.
ElevationEstimate RefineElevation(const Matte& matte, double focal,
                                  const ElevationEstimate& estimate);

// Returns the focal length, pixels, at which the silhouette's solid of revolution has straight
// walls: an assumed focal length turns a tumbler into a cone, since the same picture shows either.
// Returns nothing if the walls at `focal` are curved, taper by more than an eighth or less than a
// hundredth, or stay tapered at every focal length of a camera.
std::optional<double> StraightWallFocal(const Matte& matte, double focal, double elevation);

// Returns the intersection over union of a mesh's silhouette with the matte, from the camera.
double SilhouetteIou(const core::TriangleMesh& mesh, const core::Camera& camera,
                     const Matte& matte);

}  // namespace simwright::asset_lift
