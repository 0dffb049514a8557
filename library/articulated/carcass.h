#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "library/articulated/assembly.h"

namespace simwright::library {

constexpr double kGap = 0.003;  // m, the clearance between moving and fixed parts, as in fitted
                                // doors

Eigen::AlignedBox3d Bounds(double x0, double x1, double y0, double y1, double z0, double z1);

// Returns bottom, top, two sides and a back, which leave the inside and the front (-x) open; they
// touch but do not overlap.
std::vector<core::TriangleMesh> CarcassPanels(const Eigen::AlignedBox3d& outer, double wall);

// Returns a frame of four bars around a pane, in the plane perpendicular to x; `border` is the
// bars' width. The pane, half as thick, is centred.
std::vector<core::TriangleMesh> FrameBars(const Eigen::AlignedBox3d& outer, double border);
core::TriangleMesh Pane(const Eigen::AlignedBox3d& outer, double border, double thickness);

// Returns the joint of a door in front of a body, with the door's rear face at x: it rotates about
// its outer edge at (x, y), towards -x. On that hinge its inner corners only move away from
// neighbouring parts.
JointPlan SideHinge(double x, double y, double z, double upper, const JointResistance& feel);
// Returns the same joint about the lower edge at (x, z): an oven's door.
JointPlan BottomHinge(double x, double z, double upper, const JointResistance& feel);

// Adds a round knob with a pointer on a front at x; it rotates about x and stands out by `depth`.
int AddDial(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
            double radius, double depth, const Matter& matter);
// Adds a push button on a front, with 3 mm of travel towards +x.
int AddButton(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
              double width, double height, const Matter& matter);

}  // namespace simwright::library
