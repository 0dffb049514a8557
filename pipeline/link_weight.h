#pragma once

#include "assets/articulated_asset.h"
#include "geometry/mass_properties.h"

namespace simwright::pipeline {

// Mass (kg), centre of mass and inertia of a link from its parts and their densities, in its frame.
geometry::MassProperties Weighed(const assets::ArticulatedLink& link);

// Moves mass from links on hinges that a hand (60 N m) could not lift to the root, the whole's mass
// kept: a category's mass that is split by volume gives too much to doors whose file fills them.
// Friction that holds such a link (joint_feel.h) is taken into account. Reported, `lightened`.
void LightenHeavyHinges(assets::ArticulatedAsset* asset);

}  // namespace simwright::pipeline
