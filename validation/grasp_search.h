#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::validation {

// A parallel gripper: two fingers and the palm behind them. Lengths in metres.
struct Gripper {
  double opening = 0.08;     // distance between the open fingers
  double width = 0.02;       // a finger's, perpendicular to closing axis and length
  double thickness = 0.015;  // a finger's, along the closing axis
  double length = 0.04;      // a finger's, from the palm to the tip
  double approach = 0.10;    // length of the straight, collision-free approach
  double overlap = 0.01;     // how far the tips reach past the centre of the grasp target
};

struct GraspSearch {
  int tried = 0;  // approach directions
  int found = 0;  // approach directions with a grasp
};

// Counts from how many of 26 directions (to the faces, edges and corners of a cube) the open
// gripper has a straight collision-free approach and can close both fingers on `handle` without
// touching `others`. All parts are convex and in one frame.
GraspSearch SearchGrasps(const std::vector<core::TriangleMesh>& handle,
                         const std::vector<core::TriangleMesh>& others,
                         const Gripper& gripper = {});

}  // namespace simwright::validation
