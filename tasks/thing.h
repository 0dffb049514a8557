#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/semantic_model.h"
#include "tasks/reward/reward_scene.h"

namespace simwright::tasks {

struct ThingLink {
  std::string name;
  std::string label;  // door, handle, drawer ...; may be empty
  int parent = -1;    // a link before this one; -1 for the root
  int joint = -1;     // into Thing::joints; -1 where it is fixed to its parent
  Eigen::Isometry3d parent_from_link = Eigen::Isometry3d::Identity();  // its joint at zero
  // The outermost points of its shapes, at most 98, m, link frame; none where it has no shape.
  std::vector<Eigen::Vector3d> outline;
  Eigen::AlignedBox3d box;                           // of the shapes, link frame; may be empty
  std::vector<Eigen::AlignedBox3d> parts;            // of each shape
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of the box; where "the link is"
  double mass = 0.0;                                 // kg; 0 where the file gives none
};

struct ThingJoint {
  std::string name;
  RewardJointType type = RewardJointType::kRevolute;
  int link = -1;  // what it moves
  int grip = -1;  // the link that a hand takes: its handle, or itself
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // frame of its link, unit
  double lower = 0.0, upper = 0.0;                  // rad or m
  // A joint that follows another: position = multiplier * leader's + offset.
  int leader = -1;  // into Thing::joints; -1: it moves by itself
  double multiplier = 1.0, offset = 0.0;
  // The position nearest zero within the limits: closed, off, released.
  double rest() const { return lower > 0.0 ? lower : upper < 0.0 ? upper : 0.0; }
  // The limit farther from rest(): open, on, pressed.
  double far() const { return upper - rest() >= rest() - lower ? upper : lower; }
  // Where a hand leaves it that works it away from rest: past the 70 % of its way that count as
  // open, on, pressed, and short of its stop. What is closed next begins there: a door that stands
  // open to its stop, by more than a right angle, turns its handle away from the robot.
  double acted() const { return rest() + 0.78 * (far() - rest()); }
};

// A room inside a link: what stands around it is the link's own.
struct Cavity {
  int link = -1;
  Eigen::AlignedBox3d box;                             // m, link frame: the free box
  Eigen::Vector3d opening = Eigen::Vector3d::UnitZ();  // unit, link frame: the open side
  int door = -1;  // into Thing::joints: what closes it; -1: always open
};

// An asset as tasks see it: a tree of links with their outlines and what they are called. Constant.
struct Thing {
  std::string name;                // as programs call it
  std::string category;            // may be empty
  std::vector<ThingLink> links;    // parents first
  std::vector<ThingJoint> joints;  // those that move
  std::vector<Cavity> cavities;    // largest first
  Eigen::AlignedBox3d box;         // of all links, joints at rest, root frame
  double mass = 0.0;               // kg
  bool articulated() const { return !joints.empty(); }
  int FindLink(const std::string& name) const;   // -1: none
  int FindJoint(const std::string& name) const;  // -1: none
  double height() const { return box.sizes().z(); }
};

// What is known of `model`, called `name`. Shapes are the collision shapes, where there are none
// the visual ones. Floating and planar joints count as fixed.
Thing ThingOf(const std::string& name, const assets::SemanticModel& model);

// Where joint `index` stands: its own position, or what its leader's makes of it.
double JointPosition(const Thing& thing, const std::vector<double>& positions, std::size_t index);

// Poses of the links in the root's frame, `positions` by joint. Throws core::Error for another
// length.
std::vector<Eigen::Isometry3d> LinkPosesOf(const Thing& thing,
                                           const std::vector<double>& positions);
// The same into `poses`, whose memory is used again.
void LinkPosesOf(const Thing& thing, const std::vector<double>& positions,
                 std::vector<Eigen::Isometry3d>* poses);

// The joints' rest positions.
std::vector<double> RestPositions(const Thing& thing);

}  // namespace simwright::tasks
