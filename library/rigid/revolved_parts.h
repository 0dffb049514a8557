#pragma once

#include <vector>

#include "core/mesh.h"
#include "library/rigid/rigid_shapes.h"

namespace simwright::library {

// The convex parts of solids of revolution about the z axis. Rings are a profile's points from
// below; the first corner of each lies on the x axis.

// Returns the convex hull of rings. All have `corners` corners, except that the lowest may have
// `foot` corners: engines keep three or four contacts of a hull on a plane, and for a base of few
// corners these are the same in every step. At most 64 corners in all.
core::TriangleMesh RevolvedHull(const std::vector<ProfilePoint>& rings, int corners = 20,
                                int foot = 0);

// Returns the parts of a vessel of VesselProfile: `count` wedges of its wall, and its floor. A
// bulging wall keeps its outside; its hollow is as wide as its narrowest section. The vessel stands
// on the floor's part alone, because the solver's time depends on the number of part pairs in
// contact. A handle shifts the weight to one side, to which MuJoCo's three or four contacts then
// move: such a vessel needs a base of four corners.
std::vector<core::TriangleMesh> VesselParts(const std::vector<ProfilePoint>& outer,
                                            double thickness, double floor, int count,
                                            int foot_corners = 8);

// Returns the wall between two profiles, cut into `count` wedges (a multiple of 2). A wedge is the
// hull of its two ends and of the outer profile in its middle, so that it extends into the hollow
// by a chord's height.
std::vector<core::TriangleMesh> WallParts(const std::vector<ProfilePoint>& outer,
                                          const std::vector<ProfilePoint>& inner, int count);

// Returns the parts of a TaperedTube or Tube: `count` hulls of consecutive sections.
std::vector<core::TriangleMesh> TubeParts(const core::TexturedMesh& tube, int count);

}  // namespace simwright::library
