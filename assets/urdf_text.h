#pragma once

#include <string>

#include "core/finding.h"

namespace simwright::assets {

struct MendedUrdf {
  std::string text;         // what urdfdom is given
  core::Findings findings;  // what was changed or left out, by link or joint
};

// A URDF as urdfdom takes it. urdfdom refuses a whole file for what other readers pass over, and
// for things that mean nothing to us; these are given their defaults, replaced by what they mean, or
// left out:
//   a byte order mark, a robot without a name; materials defined twice (the first counts), without
//   a name or colour, or not defined at all; the axis of a fixed joint; a <limit> without effort or
//   velocity; empty <dynamics>, <safety_controller>, <calibration>; limits of a continuous joint;
//   an <inertial> that lacks its mass or inertia; capsules (a cylinder and two balls), geometry of
//   unknown kinds, a mesh without a file, a scale of one number.
// Throws core::Error: a text in UTF-16, an unexpanded xacro (it says how to expand it), a joint
// that moves about an axis of no length.
MendedUrdf MendUrdfText(const std::string& text, const std::string& where);

}  // namespace simwright::assets
