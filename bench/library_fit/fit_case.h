#pragma once

#include <string>
#include <vector>

#include "asset_lift/segmentation/segmentation.h"
#include "assets/articulated_asset.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/random.h"
#include "library_fit/fit_kinds.h"

namespace simwright::bench {

// A rendered photo of an object with its ground truth.
struct FitCase {
  std::string name;
  int kind = -1;              // index into FitKinds(), -1 if unknown
  core::TexturedMesh visual;  // as in the photo, in the frame of its root, m
  core::Image photo;          // RGB
  asset_lift::Matte matte;    // ground truth
  core::Camera camera;        // in the root's frame
};

// Renders the object from a random view (within 60 degrees of the front if `frontal`), 60 to 75 %
// as long as the 400 x 400 pixels, in random light, on a random crop of one of the backgrounds.
void Photograph(const std::vector<core::Image>& backgrounds, bool frontal, core::Rng* rng,
                FitCase* fit_case);

// Returns crops of the photos in examples/ without their objects.
std::vector<core::Image> ExampleBackgrounds();

// A joint's place in the camera's frame, in units of the object's diagonal.
struct SeenJoint {
  assets::JointType type = assets::JointType::kFixed;
  Eigen::Vector3d axis, pivot;  // unit axis; a point of it, from the middle of the object's bounds
  Eigen::Vector3d part;         // middle of the moved link's visual
  double size = 0.0;            // diagonal of that visual
};

// Returns the moving joints of the asset as the camera (in the root's frame) sees them. Joints of
// handles and controls, whose link is smaller than `least` diagonals, are left out.
std::vector<SeenJoint> SeenJoints(const assets::ArticulatedAsset& asset, const core::Camera& camera,
                                  double least);

// The agreement of the joints of a fit with the truth; counts over the truth's joints.
struct JointScores {
  int joints = 0, type_right = 0, axis_right = 0;
  int hinges = 0, pivot_right = 0;  // of joints that turn
  int objects = 0, parts_right = 0;
  void Add(const JointScores& other);
};

// Assigns each true joint the fitted one whose part is nearest, and compares: the type, the axis up
// to sign within 5 degrees, the pivot's distance from the true axis within 3 % of the diagonal.
JointScores CompareJoints(const std::vector<SeenJoint>& truth, const std::vector<SeenJoint>& fit);

}  // namespace simwright::bench
