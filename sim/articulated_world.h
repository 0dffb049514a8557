#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/articulated_body.h"
#include "sim/link_tree.h"
#include "sim/world.h"

namespace simwright::sim {

class BulletShape;

// A body with the shapes that Bullet collides it by. Constant; any number of worlds share it, and
// putting it into one then takes a tenth of the time.
class PreparedBody {
 public:
  // `margin`: m, as WorldOptions. Throws core::Error for parts that are no solids.
  explicit PreparedBody(ArticulatedBody body, double margin = WorldOptions().margin);
  ~PreparedBody();
  PreparedBody(const PreparedBody&) = delete;
  PreparedBody& operator=(const PreparedBody&) = delete;

  const ArticulatedBody& body() const { return body_; }

 private:
  friend class ArticulatedWorld;
  ArticulatedBody body_;
  std::vector<std::unique_ptr<BulletShape>> shapes_;  // by link
  LinkTree whole_, folded_;
};

// How a jointed thing is put into a world.
struct Placement {
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = true;                    // the root is held where it is; else it is free
  bool self_contacts = false;           // links touch each other, but for those on fixed joints
  bool contacts = true;                 // false: nothing touches it at all
  std::vector<int> through_floor = {};  // links that the floor does not touch
  // What this world's copy has of the body's own: mass (with inertia), friction of its surfaces,
  // friction and damping of its joints. Positive.
  double mass_scale = 1.0, friction_scale = 1.0, joint_scale = 1.0;
  // Links whose surfaces have another friction than the body's own: link and coefficient.
  std::vector<std::pair<int, double>> link_friction = {};
};

constexpr int kFloor = -1;  // in place of a body's index

// Two links that touch, or nearly do.
struct LinkContact {
  int body_a = kFloor, link_a = 0;
  int body_b = kFloor, link_b = 0;
  double distance = 0.0;                              // m; negative: depth
  double impulse = 0.0;                               // N s over the last step, along the normal
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, on b, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, from b towards a, world
};

// A Bullet world of jointed and rigid things in reduced coordinates (Featherstone), double
// precision, over the floor z = 0. One thread a world; nothing is shared, so that any number run
// side by side, and each is repeatable bit for bit when built and driven alike.
//
// Joints keep their limits. Their friction holds them against any load below it, damping acts
// implicitly (stable at any step), and a joint that mimics another is geared to it.
class ArticulatedWorld {
 public:
  explicit ArticulatedWorld(const WorldOptions& options = {});
  ~ArticulatedWorld();
  ArticulatedWorld(const ArticulatedWorld&) = delete;
  ArticulatedWorld& operator=(const ArticulatedWorld&) = delete;

  // Adds a thing with all joints at zero; returns its index. Throws core::Error where a link that
  // moves has no mass.
  int Add(std::shared_ptr<const PreparedBody> body, const Placement& placement = {});
  // ... of which `body` is copied.
  int Add(const ArticulatedBody& body, const Placement& placement = {});
  // A free rigid body.
  int Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // `joint` indexes ArticulatedBody::joints. Both leave velocities at zero.
  void SetPosition(int body, int joint, double position);
  void SetRootPose(int body, const Eigen::Isometry3d& world_from_root);

  // A motor turns the joint at `velocity` (rad/s or m/s) with at most `max_force` (N m or N), of
  // which the joint's friction takes its share. Velocity 0 brakes.
  void Drive(int body, int joint, double velocity, double max_force);
  void LetGo(int body, int joint);
  // The most force (N m or N) by which a joint that mimics another is kept to it; without, any.
  // Nothing for a joint that mimics none.
  void LimitMimic(int body, int joint, double max_force);
  // A force (N m or N) on the joint during the next step alone.
  void Push(int body, int joint, double force);

  // A force (N, world) on the root's centre of mass during the next step alone.
  void PushRoot(int body, const Eigen::Vector3d& force);

  // What WorldOptions::solver_iterations says, for the steps that follow: few do where nothing
  // touches. Throws core::Error below 1.
  void SetIterations(int iterations);

  void Step();
  double time() const { return time_; }
  double time_step() const { return options_.time_step; }

  double Position(int body, int joint) const;            // rad or m
  double Velocity(int body, int joint) const;            // rad/s or m/s
  Eigen::Isometry3d LinkPose(int body, int link) const;  // world_from_link
  // All pairs within Bullet's reach of each other after the last step.
  std::vector<LinkContact> Contacts() const;
  // The same into `contacts`, whose memory is used again.
  void Contacts(std::vector<LinkContact>* contacts) const;

  // The inertial as the engine holds it, back in the link's frame. Without self_contacts links on
  // fixed joints are part of what they are fixed to: it has their mass, they have none.
  assets::Inertial LoadedInertial(int body, int link) const;

 private:
  struct Bullet;
  std::unique_ptr<Bullet> bullet_;
  WorldOptions options_;
  double time_ = 0.0;
};

}  // namespace simwright::sim
