#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "twin/object_detector.h"
#include "twin/table_picture.h"
#include "twin/table_reconstruction.h"

namespace simwright::bench {

// A perfect detector's answer: an alpha for each object of at least 80 pixels; `objects` receives
// their indices in the scene.
std::vector<twin::Detection> TrueDetections(const twin::TablePicture& picture, int objects,
                                            std::vector<int>* indices);

// Returns for each detection the true detection that it shows, with an IoU above 0.5, or -1. Each
// true detection is found once, by the detection with the largest IoU.
std::vector<int> MatchedDetections(const std::vector<twin::Detection>& found,
                                   const std::vector<twin::Detection>& truth);

// Returns the frame of a reconstruction in that of a scene: below the camera, which looks towards
// +y.
Eigen::Isometry3d TwinFromScene(const core::Camera& camera);

// The errors of one object.
struct ObjectErrors {
  int truth = 0;                                    // index in the scene
  bool kind = false;                                // is right
  double position = 0.0;                            // m, of the middles, in the plane
  double yaw = 0.0;                                 // rad, up to the object's symmetry
  double size = 0.0;                                // logarithm of the ratio of the mean sides
  double position_sigmas = 0.0, size_sigmas = 0.0;  // errors over the stated deviations
};

// Compares a reconstruction with the scene; object k of it shows `objects[k]` of the scene, -1
// none. `aligned`: the frames are aligned by the rigid motion in the plane that fits best, since a
// photo alone does not tell them apart; otherwise they are those of the camera.
std::vector<ObjectErrors> JudgeTable(const twin::TableReconstruction& table,
                                     const std::vector<int>& objects, const twin::TableScene& scene,
                                     bool aligned);

}  // namespace simwright::bench
