#pragma once

#include <string>

#include "assets/asset.h"

namespace simwright::assets {

// The validity checks of a URDF before and beside urdfdom's own parsing; each throws core::Error
// naming `where`.

// Requires text without a DOCTYPE or entities (they can grow without bound or name other files)
// that is XML with a <robot> root, whose joints name existing links, with no link its own ancestor.
void RequireSafeUrdfText(const std::string& text, const std::string& where);

// The fault of an inertial and its remedy; both are empty if a rigid body can have it: a mass above
// zero, an inertia that is finite and positive definite, principal moments that satisfy the
// triangle inequality to 1e-3 (files round their digits).
struct InertialFault {
  std::string sentence, remedy;
};
InertialFault FaultOf(const Inertial& inertial);

// Throws core::Error if the inertial has a fault.
void RequirePhysical(const Inertial& inertial, const std::string& where);

}  // namespace simwright::assets
