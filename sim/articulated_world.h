#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/articulated_body.h"
#include "sim/world.h"

namespace simwright::sim {

class BulletShape;
struct LinkTree;

// A body with its Bullet collision shapes. Constant; any number of worlds share it, and adding it
// to one then takes a tenth of the time.
class PreparedBody {
 public:
  // `margin`: m, as in WorldOptions. Throws core::Error for parts with fewer than four vertices.
  explicit PreparedBody(ArticulatedBody body, double margin = WorldOptions().margin);
  ~PreparedBody();
  PreparedBody(const PreparedBody&) = delete;
  PreparedBody& operator=(const PreparedBody&) = delete;

  const ArticulatedBody& body() const { return body_; }

 private:
  friend class ArticulatedWorld;
  ArticulatedBody body_;
  std::vector<std::unique_ptr<BulletShape>> shapes_;  // by link
  std::unique_ptr<const LinkTree> whole_, folded_;
};

// The placement of a body in a world.
struct Placement {
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = true;                    // the root is fixed; else it is free
  bool self_contacts = false;           // links collide with each other, except across fixed joints
  bool contacts = true;                 // false: it collides with nothing
  std::vector<int> through_floor = {};  // links that do not collide with the floor
  // Factors on the body's own properties in this world: mass (with inertia), friction of its
  // surfaces, friction and damping of its joints. Positive.
  double mass_scale = 1.0, friction_scale = 1.0, joint_scale = 1.0;
  // Links whose surface friction differs from the body's own: link and coefficient.
  std::vector<std::pair<int, double>> link_friction = {};
};

constexpr int kFloor = -1;  // in place of a body's index

// A contact, or near contact, of two links.
struct LinkContact {
  int body_a = kFloor, link_a = 0;
  int body_b = kFloor, link_b = 0;
  double distance = 0.0;                              // m; negative: depth
  double impulse = 0.0;                               // N s over the last step, along the normal
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, on b, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, from b towards a, world
};

// A Bullet world of articulated and rigid bodies in reduced coordinates (Featherstone), in double
// precision, above the floor z = 0. One thread per world; worlds share no mutable state and can run
// in parallel, and each is bit-identical when built and driven in the same way.
//
// Joints keep their limits. Their dry friction holds them against any smaller load, damping is
// implicit (stable at any time step), and a mimic joint is geared to its leader.
class ArticulatedWorld {
 public:
  explicit ArticulatedWorld(const WorldOptions& options = {});
  ~ArticulatedWorld();
  ArticulatedWorld(const ArticulatedWorld&) = delete;
  ArticulatedWorld& operator=(const ArticulatedWorld&) = delete;

  // Adds a body with all joints at zero; returns its index. Throws core::Error if a moving link has
  // no mass.
  int Add(std::shared_ptr<const PreparedBody> body, const Placement& placement = {});
  // Adds a copy of `body`.
  int Add(const ArticulatedBody& body, const Placement& placement = {});
  // Adds a free rigid body.
  int Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // `joint` indexes ArticulatedBody::joints. Both functions set velocities to zero.
  void SetPosition(int body, int joint, double position);
  void SetRootPose(int body, const Eigen::Isometry3d& world_from_root);

  // Sets the velocity of the root of a body that is not fixed: linear (m/s, of its centre of mass)
  // and angular (rad/s), world frame.
  void SetRootVelocity(int body, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular);

  // Sets gravity (m/s^2) from the next step on.
  void SetGravity(const Eigen::Vector3d& gravity);

  // Drives the joint at `velocity` (rad/s or m/s) with at most `max_force` (N m or N), which
  // includes the joint's friction. Velocity 0 brakes.
  void Drive(int body, int joint, double velocity, double max_force);
  void Release(int body, int joint);
  // Limits the force (N m or N) that keeps a mimic joint on its leader; unlimited by default. No
  // effect on other joints.
  void LimitMimic(int body, int joint, double max_force);
  // Applies a force (N m or N) to the joint during the next step only.
  void Push(int body, int joint, double force);

  // Applies a force (N, world) to the root's centre of mass during the next step only.
  void PushRoot(int body, const Eigen::Vector3d& force);

  // Sets WorldOptions::solver_iterations for the following steps: few suffice without contacts.
  // Throws core::Error below 1.
  void SetIterations(int iterations);

  void Step();
  double time() const { return time_; }
  double time_step() const { return options_.time_step; }

  double Position(int body, int joint) const;            // rad or m
  double Velocity(int body, int joint) const;            // rad/s or m/s
  Eigen::Isometry3d LinkPose(int body, int link) const;  // world_from_link
  // Returns all contacts within Bullet's contact margin after the last step.
  std::vector<LinkContact> Contacts() const;
  // Writes the same into `contacts`, reusing its memory.
  void Contacts(std::vector<LinkContact>* contacts) const;

  // Returns the inertial as the engine holds it, in the link's frame. Without self_contacts, links
  // on fixed joints are merged into their carrier: it has their mass, they have none.
  assets::Inertial LoadedInertial(int body, int link) const;

 private:
  struct Bullet;
  std::unique_ptr<Bullet> bullet_;
  WorldOptions options_;
  double time_ = 0.0;
};

}  // namespace simwright::sim
