#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

constexpr double kHeldHeight = 1.0;  // m above the floor, of a root that is held

struct RigOptions {
  bool hold_root = true;      // at kHeldHeight; else it stands free on the floor z = 0
  bool self_contacts = true;  // links of the thing touch each other; in Bullet alone
};

// One jointed thing over the floor, in some engine: what an experiment on its joints needs. Links
// of the thing touch each other, but for those on fixed joints. One thread a rig.
class JointRig {
 public:
  virtual ~JointRig() = default;

  // `joint` indexes ArticulatedBody::joints. Velocities are zero afterwards.
  virtual void SetPosition(int joint, double position) = 0;
  virtual void SetRootPose(const Eigen::Isometry3d& world_from_root) = 0;
  // A motor turns the joint at `velocity` with at most about `max_force`, of which the joint's
  // friction and load take their share.
  virtual void Drive(int joint, double velocity, double max_force) = 0;
  virtual void LetGo(int joint) = 0;
  virtual void Step() = 0;
  virtual double time() const = 0;  // s
  virtual double Position(int joint) const = 0;
  virtual double Velocity(int joint) const = 0;
  virtual Eigen::Isometry3d LinkPose(int link) const = 0;
  // Pairs of links that touch, "door and body", sorted by name; the floor is "floor". The root on
  // the floor and links joined by fixed joints are left out.
  virtual std::set<std::string> Touching() const = 0;
  virtual assets::Inertial LoadedInertial(int link) const = 0;
  // What the engine warned of, in its own words.
  virtual std::vector<std::string> Warnings() const = 0;
};

// In Bullet (ArticulatedWorld, 240 Hz).
std::unique_ptr<JointRig> BulletRig(const ArticulatedBody& body, const RigOptions& options = {});

// In MuJoCo, from an MJCF file whose joints and bodies bear the names of the body's. Throws
// core::Error where it does not compile, or one of them is missing.
std::unique_ptr<JointRig> MujocoRig(const ArticulatedBody& body, const std::filesystem::path& mjcf,
                                    const RigOptions& options = {});

// "a and b" in alphabetical order.
std::string LinkPair(const std::string& a, const std::string& b);
// Whether two links cannot move against each other: all joints between them are fixed.
bool RigidlyJoined(const ArticulatedBody& body, int link_a, int link_b);

}  // namespace simwright::sim
