#pragma once

#include "core/finding.h"

namespace tinyxml2 {
class XMLElement;
}

namespace simwright::assets {

// Gives each <visual> of a URDF the colour that its <material> means, under a name of its own:
// urdfdom refuses a whole file where a name is defined twice, or where one has no name. A name may
// be defined beside the links or in any visual; of two definitions the first counts, and a finding
// says so where they differ. A material that nothing defines is left out, also with a finding.
void ResolveMaterials(tinyxml2::XMLElement* robot, core::Findings* findings);

}  // namespace simwright::assets
