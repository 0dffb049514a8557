#include "importers/link_weight.h"

#include <algorithm>
#include <cstdio>

#include "importers/joint_friction.h"

namespace simwright::importers {
namespace {

using assets::ArticulatedAsset;
using assets::ArticulatedLink;

constexpr double kHandTorque = 60.0;  // N m, the limit of a human in sim::DriveFor
constexpr double kShare = 0.9;        // of kHandTorque, for weight and holding friction
constexpr double kLeastMass = 0.1;    // of the link's mass, which must remain

void ReweighLink(double factor, ArticulatedLink* link) {
  for (double& density : link->densities) density *= factor;
  const geometry::MassProperties total = LinkMassProperties(*link);
  link->inertial = {total.mass, total.center_of_mass, total.inertia};
}

}  // namespace

geometry::MassProperties LinkMassProperties(const ArticulatedLink& link) {
  geometry::MassProperties total;
  for (size_t i = 0; i < link.parts.size(); ++i) {
    const auto one = geometry::SolidMassProperties(link.parts[i], link.densities[i]);
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
  }
  return total;
}

void LightenHeavyHinges(ArticulatedAsset* asset) {
  for (size_t i = 0; i < asset->joints.size(); ++i) {
    const assets::Joint& joint = asset->joints[i];
    if (!joint.Moves() || joint.type == assets::JointType::kPrismatic) continue;
    const double load = GreatestLoad(*asset, i);
    const double most = kShare * kHandTorque / (1.0 + kHoldFactor);
    if (load <= most) continue;
    ArticulatedLink& link = asset->links[i + 1];
    ArticulatedLink& root = asset->links.front();
    const double before = link.inertial.mass;
    ReweighLink(std::max(kLeastMass, most / load), &link);
    const double moved = before - link.inertial.mass;
    ReweighLink(1.0 + moved / root.inertial.mass, &root);
    char text[160];
    std::snprintf(text, sizeof(text),
                  "it would weigh %.3g kg by its volume, more than a human can lift on its hinge: "
                  "%.3g kg of it were moved to '%s'",
                  before, moved, root.name.c_str());
    asset->findings.push_back({"lightened", core::Severity::kWarning, link.name, text, moved,
                               "state masses in the file"});
  }
}

}  // namespace simwright::importers
