#pragma once

#include "core/finding.h"

namespace tinyxml2 {
class XMLElement;
}

namespace simwright::assets {

// Rewrites numbers under `robot` that other readers of URDF accept and urdfdom rejects: commas or
// semicolons between numbers, and a full stop, a comma or C's "f" after one ("-1.57.", "0.5f").
// Each change is a finding with its line. Text that is not numeric is unchanged.
void RepairNumbers(tinyxml2::XMLElement* robot, core::Findings* findings);

}  // namespace simwright::assets
