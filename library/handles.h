#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "core/random.h"

namespace simwright::library {

// What a hand or a gripper takes hold of, on a flat surface.
enum class HandleKind { kBar, kBow, kKnob };

const char* HandleName(HandleKind kind);  // "bar", "bow", "knob"
HandleKind DrawHandle(core::Rng& rng, const std::vector<HandleKind>& kinds);

struct HandlePlace {
  Eigen::Vector3d mount;   // on the surface, under the handle's middle
  Eigen::Vector3d out;     // unit, away from the surface
  Eigen::Vector3d along;   // unit, the handle's long side
  double length = 0.15;    // m, of a bar or bow
  double standoff = 0.04;  // m, from the surface to the middle of the grip: two fingers deep
};

// Convex pieces that touch but do not overlap. A bar is 12 mm square on two posts, a bow a bent
// round bar of 12 mm, a knob a head of 32 mm on a stem: each fits between fingers 8 cm apart.
std::vector<core::TriangleMesh> HandleMeshes(HandleKind kind, const HandlePlace& place);

// The middle of the grip, where a gripper would go.
Eigen::Vector3d GripPoint(const HandlePlace& place);

}  // namespace simwright::library
