#pragma once

#include <memory>

#include "sim/articulated_body.h"
#include "sim/link_tree.h"

class btMultiBody;
class btMultiBodyGearConstraint;

namespace simwright::sim {

// Sets up link `index` >= 1 of the body in `multi`, rotated to its principal axes. `tree`: of the
// body; the link is a carrier in it. Masses and moments are multiplied by `mass_scale`.
void SetUpLink(const ArticulatedBody& body, const LinkTree& tree, int index, double mass_scale,
               btMultiBody* multi);

// Couples joint `follower` to multiplier * leader + offset. Joints are indices of Bullet's links.
std::unique_ptr<btMultiBodyGearConstraint> GearTo(const assets::JointMimic& mimic, int leader,
                                                  int follower, btMultiBody* multi);

}  // namespace simwright::sim
