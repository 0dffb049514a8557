#include "assets/usd_tree.h"

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "assets/usd_body.h"

namespace simwright::assets {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Returns the type of a joint's prim. Floating joints are none: the bodies move freely.
const char* PrimType(JointType type) {
  switch (type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return "PhysicsRevoluteJoint";
    case JointType::kPrismatic:
      return "PhysicsPrismaticJoint";
    case JointType::kFixed:
      return "PhysicsFixedJoint";
    case JointType::kFloating:
    case JointType::kPlanar:
      break;
  }
  return nullptr;
}

bool Turns(JointType type) {
  return type == JointType::kRevolute || type == JointType::kContinuous;
}

void SetFrame(const std::string& body, const Eigen::Isometry3d& pose, int side, UsdPrim* prim) {
  const std::string number = std::to_string(side);
  if (!body.empty()) prim->Set("rel physics:body" + number, "<" + body + ">");
  prim->Set("point3f physics:localPos" + number, UsdFloats(Eigen::Vector3d(pose.translation())));
  prim->Set("quatf physics:localRot" + number, UsdFloats(Eigen::Quaterniond(pose.linear())));
}

}  // namespace

bool HasUsdMimic(const std::vector<Joint>& joints, const Joint& joint) {
  if (!joint.mimic.has_value()) return false;
  const auto leader = std::find_if(joints.begin(), joints.end(),
                                   [&](const Joint& j) { return j.name == joint.mimic->joint; });
  if (leader == joints.end()) return false;
  const auto slides = [](const Joint& j) { return j.type == JointType::kPrismatic; };
  return (Turns(joint.type) && Turns(leader->type)) || (slides(joint) && slides(*leader));
}

core::Findings UsdTreeFindings(const KinematicModel& model, bool fixed) {
  core::Findings findings;
  for (size_t i = 0; i < model.links().size(); ++i) {
    const KinematicLink& link = model.links()[i];
    const bool moves = i == 0 ? !fixed : model.joints()[i - 1].Moves();
    if (link.inertial.mass > 0.0 || !moves) continue;
    findings.push_back({"usd-massless-link", core::Severity::kWarning, link.name,
                        "the link has no mass; readers of USD compute one from its shapes"});
  }
  for (const Joint& joint : model.joints()) {
    if (joint.type == JointType::kFloating || joint.type == JointType::kPlanar) {
      findings.push_back({"usd-joint-left-out", core::Severity::kWarning, joint.name,
                          "UsdPhysics has no planar or floating joints; the link moves freely"});
    }
    if (!joint.mimic.has_value()) continue;
    if (HasUsdMimic(model.joints(), joint)) {
      findings.push_back({"usd-mimic-of-newton", core::Severity::kInfo, joint.name,
                          "follows a joint by Newton's schema; UsdPhysics has none, so Isaac Sim "
                          "moves it by itself"});
    } else {
      findings.push_back({"usd-mimic-left-out", core::Severity::kWarning, joint.name,
                          "no schema lets it follow a joint of another kind; it moves by itself"});
    }
  }
  return findings;
}

UsdTree::UsdTree(std::shared_ptr<const KinematicModel> model, UsdTreeStart start, std::string root)
    : model_(std::move(model)), start_(std::move(start)), root_(std::move(root)) {
  start_.positions.resize(model_->joints().size(), 0.0);
  poses_ = model_->LinkPoses(start_.positions);
  UsdNames unique;
  for (const char* taken : {"looks", "joints"}) unique.Unique(taken);
  for (size_t i = 0; i < model_->links().size(); ++i) {
    const KinematicLink& link = model_->links()[i];
    names_.push_back(unique.Unique(link.name));
    const bool is_body = i == 0 || link.inertial.mass > 0.0 || model_->joints()[i - 1].Moves();
    const auto parent = static_cast<size_t>(std::max(0, model_->ParentLink(static_cast<int>(i))));
    carriers_.push_back(is_body ? i : carriers_[parent]);
  }
}

Eigen::Isometry3d UsdTree::CarrierFromLink(size_t link) const {
  return poses_[carriers_[link]].inverse() * poses_[link];
}

UsdPrim UsdTree::Link(size_t link) const {
  // Within a carrier, no shape has this name.
  UsdPrim prim("Xform", IsBody(link) ? names_[link] : names_[link] + "_frame");
  prim.Meta("displayName", UsdString(model_->links()[link].name));
  prim.Place(IsBody(link) ? poses_[link] : CarrierFromLink(link));
  if (!IsBody(link)) return prim;
  SetUsdBody(TreeInertial(model_->links()[link].inertial), &prim);
  return prim;
}

std::vector<std::string> UsdTree::ExcludedPaths(size_t link) const {
  std::set<std::string> paths;
  for (const auto& [first, second] : model_->excluded_pairs()) {
    const size_t a = carriers_[static_cast<size_t>(first)];
    const size_t b = carriers_[static_cast<size_t>(second)];
    if (a == link && b != link) paths.insert(LinkPath(b));
  }
  return {paths.begin(), paths.end()};
}

void UsdTree::AddLinks(std::vector<UsdPrim> links, UsdPrim* root) const {
  for (size_t i = 0; i < links.size(); ++i) {
    if (!IsBody(i)) links[carriers_[i]].Add(std::move(links[i]));
  }
  for (size_t i = 0; i < links.size(); ++i) {
    if (IsBody(i)) root->Add(std::move(links[i]));
  }
}

// USD's angles are degrees, and so are those of an angular drive's stiffness and damping. The
// damping of the joint and of its motor are one drive's.
void UsdTree::SetMotion(size_t index, UsdPrim* prim) const {
  const Joint& joint = model_->joints()[index];
  const bool turns = Turns(joint.type);
  const double unit = turns ? kDegrees : 1.0;
  prim->Set("uniform token physics:axis", "\"X\"");
  if (joint.type != JointType::kContinuous) {
    prim->Set("float physics:lowerLimit", UsdFloat(unit * joint.lower));
    prim->Set("float physics:upperLimit", UsdFloat(unit * joint.upper));
  }
  const auto motor = std::find_if(start_.motors.begin(), start_.motors.end(), [&](const auto& m) {
    return m.joint == static_cast<int>(index);
  });
  const TreeMotor force = motor == start_.motors.end() ? TreeMotor() : *motor;
  const std::string kind = turns ? "angular" : "linear", drive = "drive:" + kind + ":physics:";
  prim->Apply("PhysicsDriveAPI:" + kind);
  prim->Set("uniform token " + drive + "type", "\"force\"");
  prim->Set("float " + drive + "damping", UsdFloat((joint.damping + force.damping) / unit));
  prim->Set("float " + drive + "stiffness", UsdFloat(force.stiffness / unit));
  prim->Set("float " + drive + "targetVelocity", "0");
  if (motor != start_.motors.end()) {
    prim->Set("float " + drive + "targetPosition", UsdFloat(unit * force.target));
    prim->Set("float " + drive + "maxForce", UsdFloat(force.force));
  }
  if (start_.positions[index] != 0.0) {
    prim->Apply("PhysicsJointStateAPI:" + kind);
    prim->Set("float state:" + kind + ":physics:position",
              UsdFloat(unit * start_.positions[index]));
  }
  // UsdPhysics has neither friction nor limits of velocity: those of Newton and MuJoCo.
  if (joint.friction > 0.0 || joint.velocity > 0.0) prim->Apply("NewtonJointAPI");
  if (joint.velocity > 0.0) {
    prim->Set("float newton:velocityLimit", UsdFloat(unit * joint.velocity));
  }
  if (joint.friction > 0.0) {
    prim->Apply("MjcJointAPI");
    prim->Set("float newton:friction", UsdFloat(joint.friction));
    prim->Set("uniform double mjc:frictionloss", UsdDouble(joint.friction));
    // MuJoCo's own friction is soft: a lever sinks by centimetres in seconds. MJCF has the same.
    prim->Set("uniform double[] mjc:solreffriction", "[0.004, 1]");
    prim->Set("uniform double[] mjc:solimpfriction", "[0.9999, 0.9999, 0.001, 0.5, 2]");
  }
}

void UsdTree::SetMimic(const Joint& joint, const std::vector<std::string>& names,
                       UsdPrim* prim) const {
  const int leader = model_->FindJoint(joint.mimic->joint);
  const double unit = Turns(joint.type) ? kDegrees : 1.0;
  prim->Apply("NewtonMimicAPI")
      .Set("rel newton:mimicJoint",
           "<" + root_ + "/joints/" + names[static_cast<size_t>(leader)] + ">")
      .Set("float newton:mimicCoef0", UsdFloat(unit * joint.mimic->offset))
      .Set("float newton:mimicCoef1", UsdFloat(joint.mimic->multiplier));
}

UsdPrim UsdTree::Joints() const {
  UsdPrim scope("Scope", "joints");
  UsdNames unique;
  if (start_.fixed) {
    UsdPrim held("PhysicsFixedJoint", unique.Unique("held"));
    SetFrame("", start_.world_from_root, 0, &held);
    SetFrame(LinkPath(0), Eigen::Isometry3d::Identity(), 1, &held);
    scope.Add(std::move(held));
  }
  std::vector<std::string> names;
  for (const Joint& joint : model_->joints()) names.push_back(unique.Unique(joint.name));
  for (size_t j = 0; j < model_->joints().size(); ++j) {
    const Joint& joint = model_->joints()[j];
    const char* type = PrimType(joint.type);
    if (type == nullptr || !IsBody(j + 1)) continue;
    UsdPrim prim(type, names[j]);
    prim.Meta("displayName", UsdString(joint.name));
    // The joint's x axis lies along its axis of motion.
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    if (joint.Moves()) {
      turn.linear() =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), joint.axis).matrix();
    }
    const auto parent = static_cast<size_t>(model_->parents()[j]);
    SetFrame(LinkPath(carriers_[parent]), CarrierFromLink(parent) * joint.parent_from_joint * turn,
             0, &prim);
    SetFrame(LinkPath(j + 1), turn, 1, &prim);
    if (joint.Moves()) SetMotion(j, &prim);
    if (HasUsdMimic(model_->joints(), joint)) SetMimic(joint, names, &prim);
    scope.Add(std::move(prim));
  }
  return scope;
}

}  // namespace simwright::assets
