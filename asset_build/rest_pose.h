#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/rigid_body.h"

namespace simwright::asset_build {

struct RestPose {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();  // the rotation to apply to the body
  bool rolls = false;  // RollsInPose is true, or no pose held: a ball, a lying bottle, an egg
  bool held = true;    // a drop test in that pose ended in it
};

// Finds the rest pose of `body`: the given pose, or, if the body falls over or only balances on an
// edge, one of its stable poses, first those within 20 degrees of the given one, then the most
// probable. A pose holds if the body comes to rest within 5 degrees of it; if it rocks by more than
// half a degree, the resulting pose is returned. A body that rolls in a stable pose within 20
// degrees of the given one keeps that pose, held or not. `solid`, in the body's frame, is the shape
// that the parts approximate: with few facets a round body may appear to hold.
RestPose FindRestPose(const sim::RigidBody& body, const core::TriangleMesh& solid);

// Finds the rest pose of a body whose shape is the hull of its parts.
RestPose FindRestPose(const sim::RigidBody& body);

// Returns true if the body rolls in this orientation: if its solid or the hull of its parts does.
bool RollsInPose(const sim::RigidBody& body, const core::TriangleMesh& solid,
                 const Eigen::Isometry3d& turn = Eigen::Isometry3d::Identity());

// Returns true if the rotation keeps the object upright as given: within 20 degrees, at any yaw.
bool IsUprightAsGiven(const Eigen::Isometry3d& turn);

// Describes for people how an object rests after this rotation.
std::string RestSentence(const Eigen::Isometry3d& turn, bool rolls);

}  // namespace simwright::asset_build
