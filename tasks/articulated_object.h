#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/kinematic_model.h"
#include "assets/semantic_model.h"
#include "reward/reward_scene.h"

namespace simwright::tasks {

// A link's label and geometry; its place in the tree is in the kinematic model.
struct ObjectLink {
  std::string label;  // door, handle, drawer ...; may be empty
  int joint = -1;     // index into ArticulatedObject::joints; -1 where it is fixed to its parent
  // The extreme points of its shapes, at most 134, m, link frame; none where it has no shape.
  std::vector<Eigen::Vector3d> extreme_points;
  Eigen::AlignedBox3d box;                           // bounding box of the shapes, link frame; may
                                                     // be empty
  std::vector<Eigen::AlignedBox3d> parts;            // bounding box of each shape
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // centre of the box; the link's position
  double mass = 0.0;                                 // kg; 0 where the file gives none
};

struct ObjectJoint {
  std::string name;
  reward::RewardJointType type = reward::RewardJointType::kRevolute;
  int link = -1;        // the link that it moves
  int grasp_link = -1;  // the link to grasp: its handle, or the link itself
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // unit, frame of its link
  double lower = 0.0, upper = 0.0;                  // rad or m
  // The parameters of a mimic joint: position = multiplier * leader's + offset.
  int leader = -1;  // index into ArticulatedObject::joints; -1: not a mimic joint
  double multiplier = 1.0, offset = 0.0;
  // Returns the position nearest zero within the limits: closed, off, released.
  double rest() const { return lower > 0.0 ? lower : upper < 0.0 ? upper : 0.0; }
  // Returns the limit farther from rest(): open, on, pressed.
  double far() const { return upper - rest() >= rest() - lower ? upper : lower; }
  // Returns the joint target of an action away from rest: beyond the 70 % of the range that count
  // as open, on or pressed, and short of the far limit. A subtask that closes the joint starts
  // there: a door opened to its limit, by more than a right angle, would turn its handle away from
  // the robot.
  double joint_target() const { return rest() + 0.78 * (far() - rest()); }
};

// A receptacle: a space that the walls of a single link enclose.
struct Receptacle {
  int link = -1;
  Eigen::AlignedBox3d box;                             // m, link frame: the free space
  Eigen::Vector3d opening = Eigen::Vector3d::UnitZ();  // unit, link frame: direction of the open
                                                       // side
  int door = -1;  // index into ArticulatedObject::joints: the joint that closes it; -1: always open
};

// An asset as tasks see it: its kinematic model with labels, extreme points and receptacles.
struct ArticulatedObject {
  std::string name;      // name in programs
  std::string category;  // may be empty
  std::shared_ptr<const assets::KinematicModel> kinematics;
  std::vector<ObjectLink> links;        // by link of `kinematics`
  std::vector<ObjectJoint> joints;      // the movable joints
  std::vector<Receptacle> receptacles;  // largest first
  Eigen::AlignedBox3d box;              // of all links, joints at rest, root frame
  double mass = 0.0;                    // kg
  std::optional<bool> graspable;        // assets::SemanticModel::graspable
  bool articulated() const { return !joints.empty(); }
  // Returns a link's name in the kinematic model.
  const std::string& LinkName(int link) const {
    return kinematics->links()[static_cast<std::size_t>(link)].name;
  }
  int FindLink(const std::string& name) const;   // -1 if there is none
  int FindJoint(const std::string& name) const;  // -1 if there is none
  double height() const { return box.sizes().z(); }
};

// Returns the object for `model`, called `name`. Shapes are the collision shapes, or the visual
// shapes where there are none. Floating and planar joints count as fixed.
ArticulatedObject MakeArticulatedObject(const std::string& name,
                                        const assets::SemanticModel& model);

// Returns the position of joint `index`: its own position, or for a mimic joint the one that
// follows from its leader's.
double JointPosition(const ArticulatedObject& object, const std::vector<double>& positions,
                     std::size_t index);

// Returns the poses of the links in the root's frame for `positions`, by joint. Throws core::Error
// for a wrong length.
std::vector<Eigen::Isometry3d> LinkPosesOf(const ArticulatedObject& object,
                                           const std::vector<double>& positions);
// Writes the same poses into `poses` and reuses its memory.
void LinkPosesOf(const ArticulatedObject& object, const std::vector<double>& positions,
                 std::vector<Eigen::Isometry3d>* poses);

// Returns the joints' rest positions.
std::vector<double> RestPositions(const ArticulatedObject& object);

}  // namespace simwright::tasks
