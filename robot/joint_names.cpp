#include "robot/joint_names.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/json.h"

namespace simwright::robot {
namespace {

constexpr char kPanda[] = "panda_";
constexpr std::uint64_t kMostBytes = 1 << 20;

// Franka Research 3, "Robot limits" of the manufacturer's specification: rad, 1/s, 1/s^2, 1/s^3.
constexpr JointLimits kResearch3[7] = {
    {-2.7437, 2.7437, 2.62, 10.0, 5000.0, 87.0}, {-1.7837, 1.7837, 2.62, 10.0, 5000.0, 87.0},
    {-2.9007, 2.9007, 2.62, 10.0, 5000.0, 87.0}, {-3.0421, -0.1518, 2.62, 10.0, 5000.0, 87.0},
    {-2.8065, 2.8065, 5.26, 10.0, 5000.0, 12.0}, {0.5445, 4.5169, 4.18, 10.0, 5000.0, 12.0},
    {-3.0159, 3.0159, 5.26, 10.0, 5000.0, 12.0}};

void RequireDistinct(const JointNames& names, const std::vector<std::string>& joints,
                     const std::string& where) {
  std::set<std::string> seen;
  for (const std::string& joint : joints) {
    const auto found = names.names.find(joint);
    const std::string& name = found == names.names.end() ? joint : found->second;
    if (!seen.insert(name).second) {
      throw core::Error("two joints would be named '" + name + "'", where,
                        "give them distinct names");
    }
  }
}

JointNames FromFile(const std::string& file, const std::vector<std::string>& joints) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMostBytes);
  JointNames names;
  for (const auto& [joint, field] : document.root().Members()) {
    if (std::find(joints.begin(), joints.end(), joint) == joints.end()) {
      std::string known;
      for (const std::string& one : joints) known += (known.empty() ? "" : ", ") + one;
      throw core::Error("the robot has no joint '" + joint + "'", file, "it has " + known);
    }
    names.names[joint] = field.Name();
  }
  RequireDistinct(names, joints, file);
  return names;
}

JointNames FrankaNames(const std::string& prefix, const std::vector<std::string>& joints) {
  JointNames names;
  for (const std::string& joint : joints) {
    if (!joint.starts_with(kPanda)) {
      throw core::Error("the robot's joint '" + joint + "' is not a Panda joint", "--joint-names",
                        "give a JSON file with its joint names");
    }
    names.names[joint] = prefix + joint.substr(sizeof(kPanda) - 1);
  }
  return names;
}

}  // namespace

JointNames JointNamesFor(const std::string& which, const std::vector<std::string>& joints) {
  if (which == "panda") return FrankaNames(kPanda, joints);
  if (which != "fr3") return FromFile(which, joints);
  JointNames names = FrankaNames("fr3_", joints);
  for (int j = 0; j < 7; ++j) {
    names.limits["panda_joint" + std::to_string(j + 1)] = kResearch3[j];
  }
  return names;
}

JointLimits TighterLimits(const JointLimits& a, const JointLimits& b) {
  JointLimits both;
  both.lower = std::max(a.lower, b.lower);
  both.upper = std::min(a.upper, b.upper);
  both.velocity = std::min(a.velocity, b.velocity);
  both.acceleration = std::min(a.acceleration, b.acceleration);
  both.jerk = std::min(a.jerk, b.jerk);
  both.effort = std::min(a.effort, b.effort);
  return both;
}

}  // namespace simwright::robot
