#include "assets/usd_joint.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/error.h"

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

// Sets the limits, and the damping as a drive to velocity 0. USD's angles are degrees, and so are
// those of an angular drive's damping.
void SetMotion(const Joint& joint, UsdPrim* prim) {
  const bool turns = Turns(joint.type);
  const double unit = turns ? kDegrees : 1.0;
  prim->Set("uniform token physics:axis", "\"X\"");
  if (joint.type != JointType::kContinuous) {
    prim->Set("float physics:lowerLimit", UsdFloat(unit * joint.lower));
    prim->Set("float physics:upperLimit", UsdFloat(unit * joint.upper));
  }
  const std::string drive = turns ? "drive:angular:physics:" : "drive:linear:physics:";
  prim->Apply(turns ? "PhysicsDriveAPI:angular" : "PhysicsDriveAPI:linear");
  prim->Set("uniform token " + drive + "type", "\"force\"");
  prim->Set("float " + drive + "damping", UsdFloat(joint.damping / unit));
  prim->Set("float " + drive + "stiffness", "0");
  prim->Set("float " + drive + "targetVelocity", "0");
  // UsdPhysics has neither friction nor limits of velocity: those of Newton and MuJoCo.
  if (joint.friction > 0.0 || joint.velocity > 0.0) prim->Apply("NewtonJointAPI");
  if (joint.velocity > 0.0) {
    prim->Set("float newton:velocityLimit", UsdFloat(unit * joint.velocity));
  }
  if (joint.friction > 0.0) {
    prim->Apply("MjcJointAPI");
    prim->Set("float newton:friction", UsdFloat(joint.friction));
    prim->Set("uniform double mjc:frictionloss", UsdDouble(joint.friction));
  }
}

}  // namespace

bool HasUsdMimic(const ArticulatedAsset& asset, const Joint& joint) {
  if (!joint.mimic.has_value()) return false;
  const auto leader = std::find_if(asset.joints.begin(), asset.joints.end(),
                                   [&](const Joint& j) { return j.name == joint.mimic->joint; });
  if (leader == asset.joints.end()) return false;
  const auto slides = [](const Joint& j) { return j.type == JointType::kPrismatic; };
  return (Turns(joint.type) && Turns(leader->type)) || (slides(joint) && slides(*leader));
}

UsdTree::UsdTree(const ArticulatedAsset& asset, std::string root)
    : asset_(asset), root_(std::move(root)) {
  UsdNames unique;
  for (const char* taken : {"looks", "joints"}) unique.Unique(taken);
  for (const ArticulatedLink& link : asset.links) names_.push_back(unique.Unique(link.name));
  poses_.assign(asset.links.size(), Eigen::Isometry3d::Identity());
  for (size_t j = 0; j < asset.joints.size(); ++j) {
    const Joint& joint = asset.joints[j];
    const size_t parent = LinkNamed(joint.parent, joint.name);
    if (parent > j) {
      throw core::Error("link '" + joint.parent + "' comes later than its child",
                        "joint '" + joint.name + "'");
    }
    poses_[j + 1] = poses_[parent] * joint.parent_from_joint;
  }
}

size_t UsdTree::LinkNamed(const std::string& name, const std::string& joint) const {
  for (size_t i = 0; i < asset_.links.size(); ++i) {
    if (asset_.links[i].name == name) return i;
  }
  throw core::Error("link '" + name + "' is missing", "joint '" + joint + "'");
}

void UsdTree::FilterPairs(size_t link, UsdPrim* prim) const {
  std::string others;
  for (const ExcludedPair& pair : asset_.excluded_pairs) {
    if (pair.first != asset_.links[link].name) continue;
    others += (others.empty() ? "<" : ", <") + LinkPath(LinkNamed(pair.second, "excluded")) + ">";
  }
  if (others.empty()) return;
  prim->Apply("PhysicsFilteredPairsAPI").Set("rel physics:filteredPairs", "[" + others + "]");
}

void UsdTree::SetMimic(const Joint& joint, const std::vector<std::string>& names,
                       UsdPrim* prim) const {
  for (size_t j = 0; j < asset_.joints.size(); ++j) {
    if (asset_.joints[j].name != joint.mimic->joint) continue;
    const double unit = Turns(joint.type) ? kDegrees : 1.0;
    prim->Apply("NewtonMimicAPI")
        .Set("rel newton:mimicJoint", "<" + root_ + "/joints/" + names[j] + ">")
        .Set("float newton:mimicCoef0", UsdFloat(unit * joint.mimic->offset))
        .Set("float newton:mimicCoef1", UsdFloat(joint.mimic->multiplier));
  }
}

UsdPrim UsdTree::Joints() const {
  UsdPrim scope("Scope", "joints");
  UsdNames unique;
  if (asset_.fixed) {
    UsdPrim held("PhysicsFixedJoint", unique.Unique("held"));
    SetFrame("", Eigen::Isometry3d::Identity(), 0, &held);
    SetFrame(LinkPath(0), Eigen::Isometry3d::Identity(), 1, &held);
    scope.Add(std::move(held));
  }
  std::vector<std::string> names;
  for (const Joint& joint : asset_.joints) names.push_back(unique.Unique(joint.name));
  for (size_t j = 0; j < asset_.joints.size(); ++j) {
    const Joint& joint = asset_.joints[j];
    const char* type = PrimType(joint.type);
    if (type == nullptr) continue;
    UsdPrim prim(type, names[j]);
    prim.Meta("displayName", UsdString(joint.name));
    // The joint's x axis lies along its axis of motion.
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    if (joint.Moves()) {
      turn.linear() =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), joint.axis).matrix();
    }
    SetFrame(LinkPath(LinkNamed(joint.parent, joint.name)), joint.parent_from_joint * turn, 0,
             &prim);
    SetFrame(LinkPath(j + 1), turn, 1, &prim);
    if (joint.Moves()) SetMotion(joint, &prim);
    if (HasUsdMimic(asset_, joint)) SetMimic(joint, names, &prim);
    scope.Add(std::move(prim));
  }
  return scope;
}

}  // namespace simwright::assets
