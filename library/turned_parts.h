#pragma once

#include <vector>

#include "core/mesh.h"
#include "library/rigid_shapes.h"

namespace simwright::library {

// Convex parts of what is turned about the z axis. Rings are a profile's points from below; the
// first corner of each lies at x.

// The hull of rings. All have `corners` corners, but the lowest may have `foot` of its own: engines
// keep three or four contacts of a hull on a plane, and those of a foot of few corners are the same
// from step to step. At most 64 corners in all.
core::TriangleMesh TurnedPart(const std::vector<ProfilePoint>& rings, int corners = 20,
                              int foot = 0);

// A vessel of VesselProfile: `count` wedges of its wall, and its floor. What bulges keeps its
// outside; its hollow is as wide as its narrowest place. It stands on the floor's part alone: a
// solver's time goes by the pairs of parts that touch. A handle puts the weight to one side, where
// MuJoCo's three or four contacts then all are: it wants a foot of four corners.
std::vector<core::TriangleMesh> VesselParts(const std::vector<ProfilePoint>& outer,
                                            double thickness, double floor, int count,
                                            int foot_corners = 8);

// The wall between two profiles, cut into `count` wedges (a multiple of 2). A wedge is the hull of
// its two ends and of the outer profile in its middle, so that it fills the hollow by a chord's
// height.
std::vector<core::TriangleMesh> WallParts(const std::vector<ProfilePoint>& outer,
                                          const std::vector<ProfilePoint>& inner, int count);

// A bar of TaperedTube or Tube as `count` hulls of its sections in a row.
std::vector<core::TriangleMesh> TubeParts(const core::TexturedMesh& tube, int count);

}  // namespace simwright::library
