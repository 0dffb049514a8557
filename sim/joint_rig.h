#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

constexpr double kHeldHeight = 1.0;  // m above the floor, of a fixed root

struct RigOptions {
  bool hold_root = true;      // at kHeldHeight; else it stands free on the floor z = 0
  bool self_contacts = true;  // links of the body collide; in Bullet only
};

// The test rig for joint experiments: one articulated body above the floor in a physics engine.
// Links of the body collide with each other, except across fixed joints. One thread per rig.
class JointRig {
 public:
  virtual ~JointRig() = default;

  // `joint` indexes ArticulatedBody::joints. Sets velocities to zero.
  virtual void SetPosition(int joint, double position) = 0;
  virtual void SetRootPose(const Eigen::Isometry3d& world_from_root) = 0;
  // Drives the joint at `velocity` with at most about `max_force`, which includes the joint's
  // friction and load.
  virtual void Drive(int joint, double velocity, double max_force) = 0;
  virtual void Release(int joint) = 0;
  virtual void Step() = 0;
  virtual double time() const = 0;  // s
  virtual double Position(int joint) const = 0;
  virtual double Velocity(int joint) const = 0;
  virtual Eigen::Isometry3d LinkPose(int link) const = 0;
  // Returns the pairs of touching links, "body and door", sorted by name; the floor is "floor". The
  // root on the floor and links connected by fixed joints are left out.
  virtual std::set<std::string> Touching() const = 0;
  virtual assets::Inertial LoadedInertial(int link) const = 0;
  // Returns the engine's own warnings.
  virtual std::vector<std::string> Warnings() const = 0;
};

// Creates a rig in Bullet (ArticulatedWorld, 240 Hz).
std::unique_ptr<JointRig> BulletRig(const ArticulatedBody& body, const RigOptions& options = {});

// Creates a rig in MuJoCo from an MJCF file with the body's joint and link names. Throws
// core::Error if the file does not compile, or if a name is missing.
std::unique_ptr<JointRig> MujocoRig(const ArticulatedBody& body, const std::filesystem::path& mjcf,
                                    const RigOptions& options = {});

// Returns "a and b" in alphabetical order.
std::string LinkPair(const std::string& a, const std::string& b);

}  // namespace simwright::sim
