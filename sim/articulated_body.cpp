#include "sim/articulated_body.h"

#include <utility>

#include "core/error.h"
#include "sim/capsule_folding.h"

namespace simwright::sim {
namespace {

// Throws core::Error, naming the element, unless joint i of the model can be simulated.
void RequireSimulatedJoint(const assets::UrdfModel& model, size_t i) {
  const assets::Joint& joint = model.joints[i];
  if (joint.Moves() && !model.links[i + 1].inertial) {
    throw core::Error("a moving link has no inertial",
                      model.name + " link '" + model.links[i + 1].name + "'",
                      "add an <inertial> element");
  }
  if (joint.type == assets::JointType::kFloating || joint.type == assets::JointType::kPlanar) {
    throw core::Error("floating and planar joints are not simulated",
                      model.name + " joint '" + joint.name + "'",
                      "use a tree of revolute, continuous, prismatic and fixed ones");
  }
}

}  // namespace

ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model) {
  return ArticulatedBodyFrom(model, assets::MakeKinematicModel(model));
}

ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model,
                                    std::shared_ptr<const assets::KinematicModel> kinematics) {
  for (size_t i = 0; i < model.joints.size(); ++i) RequireSimulatedJoint(model, i);
  ArticulatedBody body;
  body.kinematics = std::move(kinematics);
  for (const assets::UrdfLink& link : model.links) {
    RigidBody& copy = body.links.emplace_back();
    copy.name = link.name;
    copy.friction = link.friction;
    copy.restitution = link.restitution;
    copy.rolling_friction = link.rolling_friction;
    AddShapes(link.collisions, &copy);
    if (link.inertial) copy.inertial = *link.inertial;
  }
  return body;
}

ArticulatedBody ArticulatedBodyFrom(const RigidBody& body) {
  const std::vector<assets::KinematicLink> links = {{body.name, body.inertial}};
  return {std::make_shared<assets::KinematicModel>(body.name, links, std::vector<assets::Joint>()),
          {body}};
}

}  // namespace simwright::sim
