#pragma once

#include <string>

#include "assets/asset.h"

namespace simwright::assets {

// What is wrong with a URDF before or beside urdfdom's own parsing; each throws core::Error naming
// `where`.

// Text without a DOCTYPE or entities (they can grow without bound or name other files), that is
// XML with a <robot> root, whose joints name links that exist, with no link its own ancestor.
void RequireHarmlessUrdfText(const std::string& text, const std::string& where);

// What is wrong with an inertial, and what to do; empty sentences where a rigid body can have it: a
// mass above zero, an inertia that is finite and positive definite, principal moments that satisfy
// the triangle inequality to 1e-3 (files round their digits).
struct InertialFault {
  std::string sentence, remedy;
};
InertialFault FaultOf(const Inertial& inertial);

// Throws that fault, if there is one.
void RequirePhysical(const Inertial& inertial, const std::string& where);

}  // namespace simwright::assets
