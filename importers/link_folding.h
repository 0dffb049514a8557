#pragma once

#include "assets/urdf_reader.h"

namespace simwright::importers {

// Folds links without shapes so that every remaining link has shapes. Such a link is replaced by
// its first fixed child with shapes (taking the child's name, shapes and children); one on a fixed
// joint without such a child is removed, and its children attach to its parent. Appearance and
// motion do not change. A link's frame may change: a merged link has the child's frame. If the root
// has no such child and a moving joint hangs on it, the root gets a small cube and a finding
// (`root-marked`), and model->root_is_world is set: the asset must be held. Throws core::Error,
// naming the link, if a moving link is left without shapes.
void FoldEmptyLinks(assets::UrdfModel* model);

// Normalises the joints to our conventions and reports each change in model->findings: zero lies
// within the limits, with the greater part of the range above it; a hinge or slide without a range
// becomes fixed; a mimic joint becomes independent. With `keep_directions` the greater part of the
// range may lie below zero. Throws core::Error for floating and planar joints, which a single joint
// of an asset cannot express.
void NormaliseJoints(assets::UrdfModel* model, bool keep_directions = false);

// Scales all lengths (shapes, joint origins, the limits of slides) and rotates and moves the link
// frames. At zero joint positions all frames are parallel to the root's, which lies centred below
// the whole model; the frame of a link on a fixed joint lies at the link's centre. Inertials are
// scaled and moved with their masses kept.
void CenterAboveOrigin(double scale, assets::UrdfModel* model);

// Returns the AABB of the visuals, or of the collisions of links without visuals, in the root's
// frame at zero joint positions.
Eigen::AlignedBox3d BoundsAtZero(const assets::UrdfModel& model);

}  // namespace simwright::importers
