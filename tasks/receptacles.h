#pragma once

#include <vector>

#include "core/mesh.h"
#include "tasks/articulated_object.h"

namespace simwright::tasks {

// Returns the receptacles of a link made of convex `parts` (link frame, m). A receptacle is a
// connected set of free cells that the link itself shields in at least five of the six directions
// along its axes; its box is the largest free box around its centre. A cup's receptacle opens
// upwards, a cupboard's to the front. Receptacles smaller than `least` (m, in any direction) are
// left out, and so are side-opening ones less than 8 cm deep. The grid resolution is 1/40 of the
// link's longest side.
std::vector<Receptacle> FindReceptacles(int link, const std::vector<core::TriangleMesh>& parts,
                                        double least = 0.02);

// Assigns to each receptacle of `object` the joint that opens it: the joint of a link that covers
// the opening at rest, or the receptacle's own joint where it slides in under another link (a
// drawer). Removes receptacles that another link fills, as a drawer fills its cabinet.
void AssignDoors(ArticulatedObject* object);

}  // namespace simwright::tasks
