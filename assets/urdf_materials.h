#pragma once

#include "core/finding.h"

namespace tinyxml2 {
class XMLElement;
}

namespace simwright::assets {

// Replaces the <material> of each URDF <visual> by its resolved colour under a unique name: urdfdom
// refuses a whole file if a name is defined twice or is missing. A name may be defined beside the
// links or in any visual; of two definitions the first wins, and a finding reports a difference. An
// undefined material is removed, also with a finding.
void ResolveMaterials(tinyxml2::XMLElement* robot, core::Findings* findings);

}  // namespace simwright::assets
