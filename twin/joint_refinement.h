#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/mesh.h"
#include "twin/object_detector.h"
#include "twin/table_camera.h"
#include "twin/table_pose.h"

namespace simwright::twin {

// An object whose pose and size are refined.
struct RefinedObject {
  core::TriangleMesh mesh;  // m, object frame, z up, standing on z = 0
  ScaledPose pose;          // scale: a factor of the mesh
  // The logarithm of the factor by which the mesh should be larger to have the size that its kind
  // has on average, and its error.
  double log_size_wanted = 0.0, log_size_error = 0.3;
};

struct JointRefinementOptions {
  int width = 160;           // pixels, of the compared picture
  int steps = 60;            // of L-BFGS, at most
  double pixel_error = 0.6;  // of a pixel's colour that the model does not explain: the larger, the
                             // more the expected camera and sizes count

  bool IsValid(std::string* error) const;
};

struct JointRefinement {
  TableCamera camera;
  std::vector<ScaledPose> poses;
  double first_error = 0.0, last_error = 0.0;  // mean squared colour error over the picture
  int evaluations = 0;
};

// Moves all objects and the camera together until the outlines of the objects, with what they hide
// of each other, agree with the detections: least squares between a picture in one colour an object
// and its render, by the derivatives of the differentiable renderer and Ceres's L-BFGS. Variables:
// x, y, yaw and scale of each object; elevation, roll and focal length of the camera (those with an
// error in `guess`), whose height stays. `detections`: of object k, in the photo's pixels. Throws
// core::Error for invalid options or another number of detections.
JointRefinement RefineJointly(const std::vector<RefinedObject>& objects,
                              const std::vector<Detection>& detections,
                              const TableCameraGuess& guess, const JointRefinementOptions& options);

}  // namespace simwright::twin
