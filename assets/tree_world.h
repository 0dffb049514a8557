#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/kinematic_model.h"

namespace simwright::assets {

// A capsule: all points within `radius` of the segment from a to b, m, in the link's frame.
struct TreeCapsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// A shape of a link.
struct TreeShape {
  std::string name;                    // unique in the world, valid as a file name
  std::string file;                    // an OBJ file in the link's frame, relative to the world's
  std::optional<TreeCapsule> capsule;  // the same shape exactly, if it is one
  Eigen::Vector4f color = {0.75f, 0.72f, 0.66f, 1.0f};  // RGBA, of a visual
};

struct TreeLink {
  std::vector<TreeShape> visuals, collisions;  // collisions are convex
  double friction = 0.5;
  double restitution = 0.0;
  bool meets_floor = true;  // false: its contacts with the floor are disabled
  // True if its friction decides in all its contacts, as that of gripper fingers.
  bool friction_prevails = false;
};

// The motor of a joint: a position servo.
struct TreeMotor {
  int joint = 0;
  double stiffness = 0.0;  // N m/rad or N/m
  double damping = 0.0;    // N m s/rad or N s/m
  double force = 0.0;      // N m or N, at most
  double target = 0.0;     // rad or m, at the start
};

// An articulated or rigid body of a world. Its links do not collide with each other.
struct TreeBody {
  std::string name;    // unique in the world
  std::string prefix;  // of the names of its links and joints in MJCF; empty: none
  std::shared_ptr<const KinematicModel> kinematics;
  std::vector<TreeLink> links;    // by link of `kinematics`
  std::vector<double> positions;  // rad or m, at the start, by joint
  std::vector<TreeMotor> motors;
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = true;  // the root is fixed to the world; else it is free
};

// Returns the name of a body's link or joint in MJCF: the prefix, '_' and its own name; that of the
// root link of a body with a prefix is the prefix alone.
std::string TreeLinkName(const TreeBody& body, int link);
std::string TreeJointName(const TreeBody& body, int joint);

// Returns the inertial that the writers give a link: its own, or, if no rigid body can have its
// principal moments (one exceeds the sum of the others, as in published models of arms), that with
// all three equal to their mean, which is MuJoCo's `balanceinertia`.
Inertial TreeInertial(const Inertial& inertial);

// Throws core::Error if two bodies, links, joints or shapes would share a name, or for more than 28
// bodies.
void RequireTreeNames(const std::vector<TreeBody>& bodies);

// Return the bodies as one world over the floor z = 0. Numbers have 17 digits. Throw as
// RequireTreeNames does.
//
// MJCF: the keyframe "start" has the positions and targets of the start; bodies collide with each
// other and the floor, links of one body do not collide. MuJoCo takes the greater of two frictions,
// except for links whose friction prevails.
std::string TreeWorldMjcf(const std::string& name, const std::vector<TreeBody>& bodies);
// SDF 1.9: models in a world. SDF has no joint positions: all are at zero.
std::string TreeWorldSdf(const std::string& name, const std::vector<TreeBody>& bodies);
// Returns one body as a separate model at the origin, for Drake's directives; fixed or free is up
// to them. Its mesh files are relative to the model's.
std::string TreeModelSdf(const TreeBody& body);

}  // namespace simwright::assets
