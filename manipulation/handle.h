#pragma once

#include <memory>
#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "manipulation/grasp.h"

namespace simwright::manipulation {

// A movable joint of an articulated asset, and the link by which a hand moves it.
struct Handle {
  std::string joint, link;  // names in the URDF
  // The link as an object of grasps, in its own frame at rest: other links are obstacles at rest,
  // and those that the joint does not move also where the joint is at 40 % and 80 % of its range.
  GraspObject object;
  std::string reason;  // why no hand can take it, e.g. "it follows slide"; then `object` is unset
};

// Returns a handle for each movable joint of an asset, by tasks::ObjectJoint::grasp_link: the
// handle, knob or lever on the part that the joint moves, else the part itself. `least_friction`:
// the low end of the range of the asset's friction; 0: unknown. A link with less friction keeps its
// own. Throws core::Error for a moving link without an inertial.
std::vector<Handle> HandlesOf(const std::string& name, const assets::SemanticModel& model,
                              double least_friction);

}  // namespace simwright::manipulation
