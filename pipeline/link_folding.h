#pragma once

#include "assets/urdf_reader.h"

namespace simwright::pipeline {

// Leaves a tree in which every link has shapes: one without any takes the place of the first
// fixed child that has some (its name, its shapes, its children), and one on a fixed joint that
// finds none goes, its children hanging on its parent. What is seen and how it moves stays as it
// was. A link's frame may change: what took a place has the frame that it took.
// A root without any to take on that a moving joint hangs on gets a small cube and a finding
// (`root-marked`), and model->root_is_world is set: such an asset is to be held.
// Throws core::Error, naming the link, where a link that moves is left without shapes.
void FoldEmptyLinks(assets::UrdfModel* model);

// Brings the joints to our conventions and reports each change in model->findings: zero lies
// within the limits and the greater part of the range above it; a hinge or slide without a range
// is fixed; one that mimics another moves on its own. With `keep_directions` the greater part may
// lie below zero.
// Throws core::Error for floating and planar joints, which no one joint of an asset can be.
void NormaliseJoints(assets::UrdfModel* model, bool keep_directions = false);

// Scales all lengths (shapes, joint origins, the limits of slides) and turns and moves the links'
// frames: at zero all are parallel to the root's, which lies in the middle below the whole, and
// the frame of a link on a fixed joint lies in its middle. Inertials are scaled and moved with
// their masses kept.
void StandOnOrigin(double scale, assets::UrdfModel* model);

// Bounds of what is seen, or of what collides where a link shows nothing; root's frame, at zero.
Eigen::AlignedBox3d BoundsAtZero(const assets::UrdfModel& model);

}  // namespace simwright::pipeline
