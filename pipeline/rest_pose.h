#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/rigid_body.h"

namespace simwright::pipeline {

struct RestPose {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();  // rotation to apply to the body
  bool rolls = false;  // RollsAsItLies there, or no pose held: a ball, a lying bottle, an egg
  bool held = true;    // a drop in that pose ended in it
};

// How `body` rests: dropped as it is given; where it falls over, or only balances on an edge, in its
// stable poses, those within 20 degrees of the given one first, then the most probable. A pose
// holds when the body comes to rest within 5 degrees of it; where it rocks by more than half a
// degree the pose it rocked into is taken. What rolls in a stable pose within 20 degrees of the
// given one stays so, held or not.
// `solid`, in the body's frame, is what the parts stand for: few facets may hold what is round.
RestPose FindRestPose(const sim::RigidBody& body, const core::TriangleMesh& solid);

// The same of a body that its parts' hull stands for.
RestPose FindRestPose(const sim::RigidBody& body);

// Whether the body, so turned, rolls as it lies: its solid or the hull of its parts does.
bool RollsAsItLies(const sim::RigidBody& body, const core::TriangleMesh& solid,
                   const Eigen::Isometry3d& turn = Eigen::Isometry3d::Identity());

// Whether a thing so turned still stands the way it came: within 20 degrees, whatever its yaw.
bool StandsAsGiven(const Eigen::Isometry3d& turn);

// For a person: how a thing rests that was turned so.
std::string RestSentence(const Eigen::Isometry3d& turn, bool rolls);

}  // namespace simwright::pipeline
