#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

struct WorldOptions {
  double time_step = 1.0 / 240.0;  // s; Bullet's own rate
  int solver_iterations = 50;      // stacks and grasps slip below about 20
  double gravity = 9.81;           // m/s^2, along -z
  double margin = 5e-5;            // m, of each hull: 0.05 mm is stable and leaves no visible gap
  double floor_friction = 1.0;     // Bullet multiplies both sides': the body's own then counts
  // World only: contacts warm-start with all of the last step's impulses and have two friction
  // directions, which reduces the creep of resting objects. Drop tests keep Bullet's own settings,
  // with which their figures were measured.
  bool full_warm_start = false;
  // The height (m) of the floor's AABB: more than an object falls in a step. With Bullet's own
  // infinite bound, each part of all objects on a table is tested against the floor in each step.
  // Drop tests keep that: another contact order may end in another resting pose.
  double floor_reach = 1e9;
  // ArticulatedWorld only: steps with CompactSolver instead of Bullet's dynamics and solver, which
  // serve as its reference in tests.
  bool compact_solver = true;
  // ArticulatedWorld with CompactSolver only: a body that has been still for 0.2 s keeps its pose
  // until something that moves or is driven comes within 4 cm. For training; a check of a body's
  // drift needs it awake.
  bool sleeping = false;
};

// A Bullet world in double precision with the floor z = 0. One thread per world; worlds share no
// state and can run in parallel, and each is bit-identical when repeated.
class World {
 public:
  explicit World(const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Adds a free body; returns its index. `body` must outlive the world unchanged: adding it again
  // shares its shape. Throws core::Error for a body without parts or mass, or with a part of fewer
  // than four vertices.
  int Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // Adds a fixed body, such as welded furniture; it needs no mass.
  int AddFixed(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // Removes a body from the collision world; it keeps its pose. May be repeated.
  void Remove(int body);

  // Scales the friction coefficient of any two bodies in contact by `scale` (0 or more), for new
  // contacts.
  void ScaleFriction(double scale);

  // Sets gravity (m/s^2) from the next step on.
  void SetGravity(const Eigen::Vector3d& gravity);

  // Zeroes velocities and clears the contact cache.
  void ZeroVelocities();

  // Advances by one time step.
  void Step();

  Eigen::Isometry3d Pose(int body) const;           // world_from_body
  Eigen::Vector3d LinearVelocity(int body) const;   // of the centre of mass, m/s
  Eigen::Vector3d AngularVelocity(int body) const;  // rad/s
  double DeepestPenetration() const;                // m, over all contacts; 0 without any
  double time() const { return time_; }

  // Returns the inertial as the engine holds it, in the body's frame, for `check`.
  assets::Inertial LoadedInertial(int body) const;

 private:
  struct Bullet;
  int AddBody(const RigidBody& body, const Eigen::Isometry3d& world_from_body, double mass);

  std::unique_ptr<Bullet> bullet_;
  WorldOptions options_;
  double time_ = 0.0;
};

}  // namespace simwright::sim
