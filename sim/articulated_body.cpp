#include "sim/articulated_body.h"

#include <algorithm>

#include "assets/joint_poses.h"
#include "core/error.h"
#include "sim/capsule_folding.h"

namespace simwright::sim {
namespace {

template <typename Items>
int IndexByName(const Items& items, const std::string& name, const std::string& body,
                const char* what) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
  if (found == items.end()) throw core::Error(std::string("has no such ") + what, body, name);
  return static_cast<int>(found - items.begin());
}

}  // namespace

std::vector<int> ArticulatedBody::MovingJoints() const {
  std::vector<int> moving;
  for (size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].Moves()) moving.push_back(static_cast<int>(i));
  }
  return moving;
}

int ArticulatedBody::JointIndex(const std::string& joint) const {
  return IndexByName(joints, joint, name, "joint");
}

int ArticulatedBody::LinkIndex(const std::string& link) const {
  return IndexByName(links, link, name, "link");
}

ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model) {
  ArticulatedBody body;
  body.name = model.name;
  body.joints = model.joints;
  body.parents = assets::ParentLinks(model);
  for (size_t i = 0; i < model.links.size(); ++i) {
    const assets::UrdfLink& link = model.links[i];
    RigidBody& copy = body.links.emplace_back();
    copy.name = link.name;
    copy.friction = link.friction;
    copy.restitution = link.restitution;
    copy.rolling_friction = link.rolling_friction;
    AddShapes(link.collisions, &copy);
    if (link.inertial) {
      copy.inertial = *link.inertial;
    } else if (i > 0 && model.joints[i - 1].Moves()) {
      throw core::Error("a moving link has no inertial", model.name + " link '" + link.name + "'",
                        "add an <inertial> element");
    }
    if (i == 0) continue;
    const assets::UrdfJointType type = model.joints[i - 1].type;
    if (type == assets::UrdfJointType::kFloating || type == assets::UrdfJointType::kPlanar) {
      throw core::Error("floating and planar joints are not simulated",
                        model.name + " joint '" + model.joints[i - 1].name + "'",
                        "use a tree of revolute, continuous, prismatic and fixed ones");
    }
  }
  for (const auto& [first, second] : model.excluded_pairs) {
    const auto known = [&](const std::string& link) {
      return std::any_of(body.links.begin(), body.links.end(),
                         [&](const RigidBody& l) { return l.name == link; });
    };
    if (!known(first) || !known(second)) continue;  // the model may be a part of a larger one
    body.excluded_pairs.insert(std::minmax(body.LinkIndex(first), body.LinkIndex(second)));
  }
  return body;
}

ArticulatedBody ArticulatedBodyFrom(const RigidBody& body) {
  ArticulatedBody single;
  single.name = body.name;
  single.links = {body};
  return single;
}

assets::JointLoad LoadOn(const ArticulatedBody& body, int joint, double position) {
  std::vector<assets::Inertial> inertials;
  for (const RigidBody& link : body.links) inertials.push_back(link.inertial);
  return assets::LoadOn(inertials, body.joints, body.parents, joint, position);
}

}  // namespace simwright::sim
