#include "robot/robot_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "robot/number_text.h"
#include "robot/robot_side_file.h"

namespace simwright::robot {
namespace fs = std::filesystem;
namespace {

using assets::Joint;
using assets::JointType;

// Defaults for joints without rates; see ReadRobot.
constexpr double kTurningVelocity = 1.0, kSlidingVelocity = 0.25;
constexpr double kAccelerationOfVelocity = 3.0, kJerkOfAcceleration = 100.0;

// Combines a URDF with its side file.
class Assembler {
 public:
  Assembler(const fs::path& urdf, const fs::path& side_path)
      : urdf_path_(urdf.string()), side_path_(side_path.string()) {
    model_.urdf = assets::ReadUrdf(urdf);
    model_.kinematics = assets::MakeKinematicModel(model_.urdf);
    model_.name = model_.urdf.name;
    side_ = ReadRobotSideFile(side_path);
  }
  RobotModel Assemble();

 private:
  [[noreturn]] void FailSide(const std::string& what, const std::string& remedy) const {
    throw core::Error(what, side_path_, remedy);
  }
  const Joint& JointAt(int index) const {
    return model_.urdf.joints[static_cast<std::size_t>(index)];
  }
  int LinkNamed(const std::string& name, const std::string& role) const;
  int JointNamed(const std::string& name, const std::string& role) const;
  void AddLimits(std::size_t index);
  void AddArm();
  void AddHome();
  void AddGripper();

  std::string urdf_path_, side_path_;
  RobotSideFile side_;
  RobotModel model_;
};

int Assembler::LinkNamed(const std::string& name, const std::string& role) const {
  const auto& links = model_.urdf.links;
  const auto found =
      std::find_if(links.begin(), links.end(), [&](const auto& link) { return link.name == name; });
  if (found == links.end()) {
    FailSide(role + " names the link '" + name + "', which the URDF does not have",
             "name one of its links");
  }
  return static_cast<int>(found - links.begin());
}

int Assembler::JointNamed(const std::string& name, const std::string& role) const {
  const auto& joints = model_.urdf.joints;
  const auto found = std::find_if(joints.begin(), joints.end(),
                                  [&](const auto& joint) { return joint.name == name; });
  if (found == joints.end()) {
    FailSide(role + " names the joint '" + name + "', which the URDF does not have",
             "name one of its joints");
  }
  return static_cast<int>(found - joints.begin());
}

void Assembler::AddLimits(std::size_t index) {
  const Joint& joint = model_.urdf.joints[index];
  JointLimits& limits = model_.limits[index];
  if (!joint.Moves()) return;
  const std::string where = urdf_path_ + " joint '" + joint.name + "'";
  if (joint.type == JointType::kFloating || joint.type == JointType::kPlanar) {
    throw core::Error("the joint is floating or planar", where, "use revolute or prismatic joints");
  }
  limits.lower = joint.lower;
  limits.upper = joint.upper;
  if (joint.type == JointType::kContinuous) {
    limits.lower = -std::numbers::pi;
    limits.upper = std::numbers::pi;
  }
  if (!(limits.upper > limits.lower)) {
    throw core::Error("the joint cannot move: its limits are " + DisplayText(limits.lower) +
                          " to " + DisplayText(limits.upper),
                      where, "give it a lower limit below its upper one, or make it fixed");
  }
  if (!std::isfinite(joint.velocity) || !std::isfinite(joint.effort) || joint.velocity < 0.0 ||
      joint.effort < 0.0) {
    throw core::Error("its velocity or effort is negative or not finite", where);
  }
  const auto found = side_.limits.find(joint.name);
  const StatedLimits stated = found == side_.limits.end() ? StatedLimits() : found->second;
  const double usual = joint.type == JointType::kPrismatic ? kSlidingVelocity : kTurningVelocity;
  limits.velocity = stated.velocity.value_or(joint.velocity > 0.0 ? joint.velocity : usual);
  limits.acceleration = stated.acceleration.value_or(kAccelerationOfVelocity * limits.velocity);
  limits.jerk = stated.jerk.value_or(kJerkOfAcceleration * limits.acceleration);
  limits.effort = stated.effort.value_or(joint.effort);
  const JointLimits command = CommandLimits(limits, model_.margin);
  if (!(command.velocity > 0.0 && command.acceleration > 0.0 && command.jerk > 0.0)) {
    throw core::Error("the margin leaves the joint no velocity, acceleration or jerk",
                      side_path_ + ": limits." + joint.name, "raise the limit or lower the margin");
  }
}

// Walks from the tool to the root and reverses the chain: a link has one parent, but a parent many
// children.
void Assembler::AddArm() {
  std::vector<int> moving;
  std::vector<int> chain;
  for (int link = model_.tool_link; link != 0; link = model_.kinematics->ParentLink(link)) {
    chain.push_back(link - 1);
  }
  std::reverse(chain.begin(), chain.end());
  Eigen::Isometry3d last_from_here = Eigen::Isometry3d::Identity();
  for (const int index : chain) {
    const Joint& joint = JointAt(index);
    last_from_here = last_from_here * joint.parent_from_joint;
    if (!joint.Moves()) continue;
    const JointLimits& limits = model_.limits[static_cast<std::size_t>(index)];
    model_.arm.joints.push_back({joint.name, last_from_here, joint.axis, limits.lower, limits.upper,
                                 joint.type == JointType::kPrismatic});
    model_.arm_joints.push_back(index);
    last_from_here.setIdentity();
  }
  model_.arm.name = model_.name;
  model_.arm.last_from_tool = last_from_here;
  model_.base_joint_count = static_cast<int>(side_.base_joints.size());

  std::vector<std::string> named = side_.base_joints;
  named.insert(named.end(), side_.arm_joints.begin(), side_.arm_joints.end());
  for (const std::string& name : named) JointNamed(name, "base_joints or arm_joints");
  const std::string remedy = "list base_joints, then arm_joints, from the root to the tool";
  for (std::size_t i = 0; i < std::max(named.size(), model_.arm.joints.size()); ++i) {
    const std::string found = i < model_.arm.joints.size() ? model_.arm.joints[i].name : "";
    const std::string given = i < named.size() ? named[i] : "";
    if (found == given) continue;
    if (given.empty()) FailSide("'" + found + "' moves the tool, but is not listed", remedy);
    if (found.empty()) FailSide("'" + given + "' does not lead to the tool", remedy);
    FailSide("the joints are not a chain: '" + given + "' is listed where '" + found +
                 "' is the next that leads to the tool",
             remedy);
  }
  if (side_.arm_joints.empty()) FailSide("arm_joints names no joints", remedy);
}

void Assembler::AddHome() {
  model_.arm.ready.resize(model_.arm.size());
  for (int j = 0; j < model_.arm.size(); ++j) {
    const ArmJoint& joint = model_.arm.joints[static_cast<std::size_t>(j)];
    const auto found = side_.home.find(joint.name);
    if (found == side_.home.end()) FailSide("home has no '" + joint.name + "'", "add it");
    const double value = found->second;
    if (value < joint.lower || value > joint.upper) {
      FailSide("home puts '" + joint.name + "' at " + DisplayText(value) + ", outside its limits " +
                   DisplayText(joint.lower) + " to " + DisplayText(joint.upper),
               "choose a position within them");
    }
    model_.arm.ready[j] = value;
  }
  for (const auto& [name, value] : side_.home) {
    const auto& joints = model_.arm.joints;
    if (std::none_of(joints.begin(), joints.end(),
                     [&name = name](const ArmJoint& joint) { return joint.name == name; })) {
      FailSide("home names the joint '" + name + "', which is not in the arm", "remove it");
    }
  }
}

void Assembler::AddGripper() {
  Gripper& gripper = model_.gripper;
  for (const std::string& name : side_.gripper_joints) {
    const int index = JointNamed(name, "gripper.joints");
    if (!JointAt(index).Moves()) FailSide("the gripper's joint '" + name + "' is fixed", "");
    const auto& arm = model_.arm_joints;
    if (std::find(arm.begin(), arm.end(), index) != arm.end()) {
      FailSide("'" + name + "' is a joint of the arm and of the gripper", "list it once");
    }
    gripper.joints.push_back(index);
  }
  for (const std::string& name : side_.finger_links) {
    gripper.links.push_back(LinkNamed(name, "gripper.finger_links"));
  }
  const JointLimits& limits = model_.limits[static_cast<std::size_t>(gripper.joints.front())];
  for (const double value : {side_.closed, side_.open}) {
    if (value >= limits.lower && value <= limits.upper) continue;
    FailSide("the gripper's position " + DisplayText(value) + " is outside the limits of '" +
                 side_.gripper_joints.front() + "', " + DisplayText(limits.lower) + " to " +
                 DisplayText(limits.upper),
             "choose a position within them");
  }
  gripper.closed = side_.closed;
  gripper.open = side_.open;
  gripper.opening_ratio = side_.opening_ratio;
  gripper.grip_force = side_.grip_force;
}

RobotModel Assembler::Assemble() {
  model_.margin = side_.margin;
  for (const auto& [name, stated] : side_.limits) JointNamed(name, "limits");
  model_.limits.resize(model_.urdf.joints.size());
  for (std::size_t i = 0; i < model_.urdf.joints.size(); ++i) AddLimits(i);
  model_.tool_link = LinkNamed(side_.tool_link, "tool_link");
  AddArm();
  AddHome();
  AddGripper();
  for (const auto& [a, b] : side_.ignored_collisions) {
    model_.ignored_collisions.emplace_back(LinkNamed(a, "ignored_collisions"),
                                           LinkNamed(b, "ignored_collisions"));
  }
  return std::move(model_);
}

}  // namespace

double Gripper::LeaderAt(double opening) const {
  const double share = std::clamp(opening / MaxOpening(), 0.0, 1.0);
  return closed + share * (open - closed);
}

double Gripper::Opening(double position) const {
  return opening_ratio * std::abs(position - closed);
}

std::vector<JointLimits> RobotModel::ArmLimits() const {
  std::vector<JointLimits> chosen;
  for (const int index : arm_joints) chosen.push_back(limits[static_cast<std::size_t>(index)]);
  return chosen;
}

std::vector<Eigen::Isometry3d> RobotModel::LinkPoses(
    const Eigen::Ref<const Eigen::VectorXd>& arm_positions, double leader) const {
  if (arm_positions.size() != arm.size()) {
    throw core::Error("got " + std::to_string(arm_positions.size()) +
                          " positions of the arm, which has " + std::to_string(arm.size()) +
                          " joints",
                      name);
  }
  std::vector<double> positions(kinematics->joints().size(), 0.0);
  for (std::size_t j = 0; j < arm_joints.size(); ++j) {
    positions[static_cast<std::size_t>(arm_joints[j])] =
        arm_positions[static_cast<Eigen::Index>(j)];
  }
  for (const int joint : gripper.joints) positions[static_cast<std::size_t>(joint)] = leader;
  return kinematics->LinkPoses(positions);
}

RobotModel ReadRobot(const fs::path& urdf) {
  return Assembler(urdf, fs::path(urdf).replace_extension(".json")).Assemble();
}

}  // namespace simwright::robot
