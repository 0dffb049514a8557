#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::manipulation {

// Returns a grasp (link_from_tool) near `link_from_tool` whose pads hold the outer section of a
// part alone and are parallel to it: the bar of a knob and not the thicker stem below it, on which
// pads slip as they turn. The tool rotates by at most 30 degrees about its approach (z), to where
// the outer section is thinnest along the closing axis (y), and moves back along it. It does not
// move if the pads hold nothing wider already, or if less than 8 mm of the part would remain
// between them. `parts`: convex, closed, m, link frame. `tip`: m from the tool frame, in the middle
// of the pads, to the fingertips.
Eigen::Isometry3d GraspOfOuterSection(const std::vector<core::TriangleMesh>& parts,
                                      const Eigen::Isometry3d& link_from_tool, double tip);

}  // namespace simwright::manipulation
