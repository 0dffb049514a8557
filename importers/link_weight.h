#pragma once

#include "assets/articulated_asset.h"
#include "geometry/mass_properties.h"

namespace simwright::importers {

// Computes mass (kg), centre of mass and inertia of a link from its parts and their densities, in
// its frame.
geometry::MassProperties LinkMassProperties(const assets::ArticulatedLink& link);

// Moves mass to the root from hinged links that a human (60 N m) could not lift, keeping the total
// mass: a category's mass split by volume gives too much to doors whose file fills them. Takes
// friction that holds such a link (joint_feel.h) into account. Reported as `lightened`.
void LightenHeavyHinges(assets::ArticulatedAsset* asset);

}  // namespace simwright::importers
