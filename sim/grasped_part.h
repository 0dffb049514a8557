#pragma once

#include <string>
#include <vector>

#include "sim/articulated_body.h"

namespace simwright::sim {

// A link of an articulated body that fingers hold to move a joint; the root of the body is fixed.
struct GraspedPart {
  ArticulatedBody body;
  int link = -1;                       // that the fingers hold; the joint moves it
  int joint = -1;                      // index into body.joints()
  double rest = 0.0, far = 0.0;        // rad or m: where the joint starts, and the end of its range
  std::vector<double> positions = {};  // rad or m, of all joints at the start; empty: zero

  // Returns false, with the reason, if an index is out of range, the joint does not move the link
  // or has no range, or the link and those rigidly joined to it have no collision part.
  bool IsValid(std::string* error) const;
  // Returns `positions` by joint, that of `joint` replaced by `position` (rad or m).
  std::vector<double> PositionsAt(double position) const;
  // Returns, by link, true if it is rigidly joined to `link`.
  std::vector<bool> Held() const;
  // Returns the mass (kg) that the joint moves.
  double MovedMass() const;
};

}  // namespace simwright::sim
