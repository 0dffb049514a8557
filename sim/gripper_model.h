#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "sim/articulated_body.h"

namespace simwright::sim {

// A gripper with two parallel fingers that move by equal distances. All shapes are in the tool
// frame, m: its origin lies between the fingertips, z points along the approach, y from finger to
// finger.
struct GripperModel {
  std::string name;
  std::vector<core::TriangleMesh> palm;                    // convex parts
  std::vector<std::optional<Capsule>> palm_capsules = {};  // as RigidBody::capsules
  // Convex parts at full opening. fingers[0] closes along -y, fingers[1] along +y.
  std::array<std::vector<core::TriangleMesh>, 2> fingers;
  double max_opening = 0.0;   // m between the finger pads
  double force = 0.0;         // N of each finger
  double finger_mass = 0.03;  // kg
  double friction = 1.0;      // of the pads; the coefficient of a pair is the product of both
  // m: lever arm of the friction that resists turning about the normal of a contact. A soft pad
  // touches a round object in a patch; at an even pressure it is 2/3 of the patch's radius.
  double torsion = 0.003;

  bool IsValid(std::string* error) const;
};

// Links of GripperBody. Link i moves on joint i - 1.
constexpr int kPalmLink = 0, kFirstFingerLink = 1;

// Returns the gripper as an articulated body whose root frame is the tool frame. The position of
// both finger joints is the distance (m) by which each finger has closed, from 0 to half the
// opening; the second mimics the first. `palm_mass` in kg. `finger_damping` in N s/m. Throws
// core::Error for an invalid model.
ArticulatedBody GripperBody(const GripperModel& gripper, double palm_mass, double finger_damping);

}  // namespace simwright::sim
