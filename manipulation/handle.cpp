#include "manipulation/handle.h"

#include <algorithm>
#include <array>
#include <utility>

#include "sim/articulated_body.h"
#include "tasks/articulated_object.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;

constexpr std::array kPassed = {0.4, 0.8};  // shares of the joint's range
constexpr double kLeastRange = 1e-4;        // rad or m

// Appends the parts of a link, in the frame `frame_from_link` leads to.
void AddParts(const sim::RigidBody& link, const Isometry3d& frame_from_link,
              std::vector<core::TriangleMesh>* parts) {
  for (core::TriangleMesh part : link.parts) {
    core::Transform(Eigen::Affine3d(frame_from_link), &part);
    parts->push_back(std::move(part));
  }
}

// Makes the handles of one asset.
class HandleFinder {
 public:
  HandleFinder(const std::string& name, const assets::SemanticModel& model, double least_friction)
      : least_friction_(least_friction),
        object_(tasks::MakeArticulatedObject(name, model)),
        body_(sim::ArticulatedBodyFrom(model.model, object_.kinematics)) {
    for (const assets::Joint& joint : body_.joints()) {
      const int index = object_.FindJoint(joint.name);
      rest_.push_back(index < 0 ? 0.0 : object_.joints[static_cast<size_t>(index)].rest());
    }
  }

  std::vector<Handle> Find() const {
    std::vector<Handle> handles;
    for (const tasks::ObjectJoint& joint : object_.joints) handles.push_back(HandleOf(joint));
    return handles;
  }

 private:
  Handle HandleOf(const tasks::ObjectJoint& joint) const {
    Handle handle;
    handle.joint = joint.name;
    handle.link = object_.LinkName(joint.grasp_link);
    sim::GraspedPart part;
    part.body = body_;
    part.link = joint.grasp_link;
    part.joint = body_.kinematics->JointIndex(joint.name);
    part.rest = joint.rest();
    part.far = joint.far();
    part.positions = rest_;
    if (const auto& mimic = body_.joints()[static_cast<size_t>(part.joint)].mimic) {
      handle.reason = "it follows " + mimic->joint;
    } else if (std::abs(part.far - part.rest) < kLeastRange) {
      handle.reason = "it has no range";
    } else if (body_.links[static_cast<size_t>(part.link)].parts.empty()) {
      handle.reason = handle.link + " has no collision part";
    } else {
      handle.object = ObjectOf(std::move(part));
    }
    return handle;
  }

  GraspObject ObjectOf(sim::GraspedPart part) const {
    const auto held = static_cast<size_t>(part.link);
    const sim::RigidBody& link = body_.links[held];
    GraspObject object;
    object.name = object_.name + " " + link.name;
    for (const core::TriangleMesh& mesh : link.parts) core::Append(mesh, &object.surface);
    object.body = link;
    object.friction =
        least_friction_ > 0.0 ? std::min(least_friction_, link.friction) : link.friction;
    const std::vector<Isometry3d> rest = body_.kinematics->LinkPoses(part.PositionsAt(part.rest));
    object.support_from_object = rest[held];
    for (size_t i = 0; i < body_.links.size(); ++i) {
      if (i != held) AddParts(body_.links[i], rest[held].inverse() * rest[i], &object.obstacles);
    }
    const std::vector<bool> moved = body_.kinematics->Subtree(part.joint + 1);
    for (const double share : kPassed) {
      const std::vector<Isometry3d> poses =
          body_.kinematics->LinkPoses(part.PositionsAt(part.rest + share * (part.far - part.rest)));
      for (size_t i = 0; i < body_.links.size(); ++i) {
        if (moved[i]) continue;
        AddParts(body_.links[i], poses[held].inverse() * poses[i], &object.passed);
      }
    }
    object.part = std::move(part);
    return object;
  }

  double least_friction_;
  tasks::ArticulatedObject object_;
  sim::ArticulatedBody body_;
  std::vector<double> rest_;  // rad or m, by joint of the body
};

}  // namespace

std::vector<Handle> HandlesOf(const std::string& name, const assets::SemanticModel& model,
                              double least_friction) {
  return HandleFinder(name, model, least_friction).Find();
}

}  // namespace simwright::manipulation
