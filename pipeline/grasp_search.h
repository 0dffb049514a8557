#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::pipeline {

// A parallel gripper: two fingers and the palm behind them. Metres.
struct Gripper {
  double opening = 0.08;     // between the open fingers
  double width = 0.02;       // of a finger, across both other directions
  double thickness = 0.015;  // of a finger, along the way it closes
  double length = 0.04;      // of a finger, from the palm to its tip
  double approach = 0.10;    // the straight way in that has to be free
  double overlap = 0.01;     // the tips reach so far past the middle of what is held
};

struct GraspSearch {
  int tried = 0;  // directions of approach
  int found = 0;  // of them, those from which it is held
};

// From how many of 26 directions (to the faces, edges and corners of a cube) the gripper can come
// in straight, open and free of everything, and close on `handle` with both fingers, free of
// `others`. All parts are convex and in one frame.
GraspSearch SearchGrasps(const std::vector<core::TriangleMesh>& handle,
                         const std::vector<core::TriangleMesh>& others,
                         const Gripper& gripper = {});

}  // namespace simwright::pipeline
