#pragma once

#include "core/finding.h"

namespace tinyxml2 {
class XMLElement;
}

namespace simwright::assets {

// Rewrites numbers under `robot` that other readers of URDF take and urdfdom refuses: commas or
// semicolons between numbers, and a full stop, a comma or C's "f" after one ("-1.57.", "0.5f").
// Each is a finding with its line. What is no number at all stays as it is.
void MendNumbers(tinyxml2::XMLElement* robot, core::Findings* findings);

}  // namespace simwright::assets
