#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "library/draws.h"

namespace simwright::library {

// The handles that a gripper grasps, on a flat surface.
enum class HandleKind { kBar, kBow, kKnob };

const char* HandleName(HandleKind kind);  // "bar", "bow", "knob"
HandleKind SampleHandleKind(Draws& draws, const std::vector<HandleKind>& kinds);

struct HandlePlacement {
  Eigen::Vector3d mount;   // on the surface, under the handle's centre
  Eigen::Vector3d out;     // unit, away from the surface
  Eigen::Vector3d along;   // unit, along the handle's long side
  double length = 0.15;    // m, of a bar or bow
  double standoff = 0.04;  // m, from the surface to the grip's centre: two fingers deep
};

// Returns convex pieces that touch but do not overlap. A bar is 12 mm square on two posts, a bow is
// a bent round bar of 12 mm, a knob is a head of 32 mm on a stem: each fits between fingers 8 cm
// apart.
std::vector<core::TriangleMesh> HandleMeshes(HandleKind kind, const HandlePlacement& place);

// Returns the centre of the grip, the grasp point of a gripper.
Eigen::Vector3d GripPoint(const HandlePlacement& place);

}  // namespace simwright::library
