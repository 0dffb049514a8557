#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "library/assembly.h"

namespace simwright::library {

constexpr double kGap = 0.003;  // m, between what moves and what stands: as of fitted doors

Eigen::AlignedBox3d Bounds(double x0, double x1, double y0, double y1, double z0, double z1);

// Bottom, top, two sides and a back that leave the inside free and the front (-x) open; they touch
// but do not overlap.
std::vector<core::TriangleMesh> CarcassPanels(const Eigen::AlignedBox3d& outer, double wall);

// A frame of four bars around a pane, in the plane across x; `border` is the bars' width and the
// pane, half as thick, lies in the middle.
std::vector<core::TriangleMesh> FrameBars(const Eigen::AlignedBox3d& outer, double border);
core::TriangleMesh Pane(const Eigen::AlignedBox3d& outer, double border, double thickness);

// A door before a body whose rear face is at x: it turns about its outer edge at (x, y), towards
// -x. On a hinge there its inner corners only move away from what stands beside it.
JointPlan SideHinge(double x, double y, double z, double upper, const Feel& feel);
// The same about its lower edge at (x, z): an oven's door.
JointPlan BottomHinge(double x, double z, double upper, const Feel& feel);

// A round knob on a front at x that turns about x, `out` beyond it, with a pointer.
int AddDial(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
            double radius, double depth, const Matter& matter);
// A push button on a front, 3 mm of travel towards +x.
int AddButton(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
              double width, double height, const Matter& matter);

}  // namespace simwright::library
