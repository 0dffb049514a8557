#pragma once

#include <string>

#include "core/finding.h"

namespace simwright::assets {

struct RepairedUrdf {
  std::string text;         // the input of urdfdom
  core::Findings findings;  // the changes and omissions, by link or joint
};

// Repairs a URDF for urdfdom, which rejects a whole file for defects that other readers ignore and
// for elements that we do not use. These are set to their defaults, replaced by their meaning, or
// removed:
//   a byte order mark, a robot without a name; materials defined twice (the first wins), without
//   a name or colour, or not defined at all; the axis of a fixed joint; a <limit> without effort or
//   velocity; empty <dynamics>, <safety_controller>, <calibration>; limits of a continuous joint;
//   an <inertial> that lacks its mass or inertia; capsules (a cylinder and two balls), geometry of
//   unknown kinds, a mesh without a file, a scale of one number.
// Throws core::Error for a text in UTF-16, an unexpanded xacro (with the command to expand it), or
// a joint that moves about an axis of zero length.
RepairedUrdf RepairUrdfText(const std::string& text, const std::string& where);

}  // namespace simwright::assets
