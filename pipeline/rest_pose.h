#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/rigid_body.h"

namespace simwright::pipeline {

struct RestPose {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();  // rotation to apply to the body
  bool as_given = true;   // it stands the way it came (turned by less than 5 degrees)
  bool rolls = false;     // it comes to rest nowhere in particular: a ball
  std::string sentence;   // for a person
};

// How `body` rests: dropped as it is given; where it falls over, in its stable poses, most
// probable first. A pose holds when the body comes to rest within 5 degrees of it; where it rocks
// by more than half a degree the pose it rocked into is taken. `solid` is the body's closed
// surface, in its frame.
RestPose FindRestPose(const sim::RigidBody& body, const core::TriangleMesh& solid);

}  // namespace simwright::pipeline
