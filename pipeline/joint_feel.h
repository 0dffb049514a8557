#pragma once

#include "assets/articulated_asset.h"
#include "core/random.h"

namespace simwright::pipeline {

inline constexpr double kHoldFactor = 1.3;  // of the greatest weight on a joint, as in the library

// The greatest torque (N m) or force (N) of weight on a joint over its range, all others at zero.
double GreatestLoad(const assets::ArticulatedAsset& asset, size_t joint);

// Gives the joints of a thing with its inertials what its file left out: friction as a hand meets
// it (library::DrawFeel, at the farthest point from a hinge), at most a tenth of the whole's
// weight there, so that what stands free is not pulled over; damping in proportion. Friction of
// every joint is then at least 1.3 times the greatest weight on it; effort and velocity follow
// where the file gives none. (docs/formats.md)
void GiveJointsFeel(core::Rng& rng, assets::ArticulatedAsset* asset);

}  // namespace simwright::pipeline
