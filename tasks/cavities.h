#pragma once

#include <vector>

#include "core/mesh.h"
#include "tasks/thing.h"

namespace simwright::tasks {

// The rooms inside a link made of convex `parts` (link frame, m): connected points that the link
// itself shields in at least five of the six directions along its axes; each with the largest box
// about its middle that is free. A cup's is open above, a cupboard's to the front. Rooms smaller
// than `least` (m, in any direction), or open to a side and less than 8 cm deep, are left out.
// Resolution: 1/40 of the longest side.
std::vector<Cavity> FindCavities(int link, const std::vector<core::TriangleMesh>& parts,
                                 double least = 0.02);

// Names, for every cavity of `thing`, the joint that opens it: that of a link which covers the
// opening while at rest, or the cavity's own where it slides in under another (a drawer). Removes
// those that another link fills, as a drawer fills its cabinet.
void FindDoors(Thing* thing);

}  // namespace simwright::tasks
