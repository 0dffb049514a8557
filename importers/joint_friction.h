#pragma once

#include "assets/articulated_asset.h"
#include "core/random.h"

namespace simwright::importers {

inline constexpr double kHoldFactor = 1.3;  // friction over the greatest gravity load

// Returns the greatest gravity torque (N m) or force (N) on a joint over its range, with all others
// at zero.
double GreatestLoad(const assets::ArticulatedAsset& asset, size_t joint);

// Fills in the joint parameters that the file of an asset with inertials omits. Friction is sampled
// as the resistance at the point farthest from a hinge (library::SampleJointResistance), at most a
// tenth of the whole asset's weight there so that a free-standing asset is not pulled over; damping
// is proportional. Friction of every joint is then raised to at least 1.3 times its greatest
// gravity load; effort and velocity limits follow where the file gives none (docs/formats.md).
// Findings "joint-guessed" and "joint-friction-raised" name the joints and their values.
void AssignJointFriction(core::Rng& rng, assets::ArticulatedAsset* asset);

}  // namespace simwright::importers
