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
  // Of World: contacts begin with all of the last step's impulses and resist across both
  // directions. A lid that lies still crept by 0.4 mm/s with Bullet's own 0.85 and a single
  // direction, by 0.15 so, by 0.03 with Bullet's own and 200 iterations, which take three times as
  // long. Drop tests, whose figures were measured so, keep Bullet's own.
  bool firm_contacts = false;
  // m over the floor up to which it is held against things: more than a thing falls in a step.
  // Without end, as Bullet has it, each part of all that stands on a table is held against it in
  // each step. Drop tests keep that: contacts in another order may end in another rest.
  double floor_reach = 1e9;
  // Of ArticulatedWorld: the iterations by CompactSolver; else by Bullet, which it is tested
  // against and compared with.
  bool compact_solver = true;
};

// A Bullet world in double precision with the floor z = 0. One thread a world; nothing is shared,
// so that any number run side by side and each is repeatable bit for bit.
class World {
 public:
  explicit World(const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Adds a free body; `body` must outlive the world, as it is: what is added again shares its
  // shape. Returns its index. Throws core::Error for a body without parts or mass, or with a part
  // of fewer than four vertices.
  int Add(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // The same, of a body that stays where it is, as welded furniture does; it needs no mass.
  int AddFixed(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

  // Takes a body out: nothing touches it any more, and it keeps its pose. Once or more.
  void Remove(int body);

  // Of any two that touch, to so many times (0 or more) their own, from the next contact on.
  void ScaleFriction(double scale);

  // m/s^2, from the next step on.
  void SetGravity(const Eigen::Vector3d& gravity);

  // As if all had just been put where it is: at rest, and nothing known of contacts before.
  void Rest();

  // One time step.
  void Step();

  Eigen::Isometry3d Pose(int body) const;           // world_from_body
  Eigen::Vector3d LinearVelocity(int body) const;   // of the centre of mass, m/s
  Eigen::Vector3d AngularVelocity(int body) const;  // rad/s
  double DeepestPenetration() const;                // m, over all contacts; 0 without any
  double time() const { return time_; }

  // The inertial as the engine holds it, back in the body's frame: what `check` compares.
  assets::Inertial LoadedInertial(int body) const;

 private:
  struct Bullet;
  int AddBody(const RigidBody& body, const Eigen::Isometry3d& world_from_body, double mass);

  std::unique_ptr<Bullet> bullet_;
  WorldOptions options_;
  double time_ = 0.0;
};

}  // namespace simwright::sim
