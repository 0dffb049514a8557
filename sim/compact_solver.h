#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "sim/constraint_row.h"
#include "sim/joint_motor.h"
#include "sim/tree_dynamics.h"

class btCollisionObject;
class btDispatcher;
class btManifoldPoint;
class btOverlappingPairCache;
class btPersistentManifold;

namespace simwright::sim {

// A joint as the solver sees it.
struct SolverJoint {
  int link = 0;  // Bullet's index of its child link
  const JointMotor* motor = nullptr;
  bool limited = false;
  double lower = 0.0, upper = 0.0;  // rad or m
  // A gear to link `leader`: position = multiplier * the leader's + offset. -1: none.
  int leader = -1;
  double multiplier = 1.0, offset = 0.0;
  const double* gear_force = nullptr;  // N m or N at most
  // The impulses of the last step (N m s or N s): the motor's, the lower and the upper limit's, and
  // the gear's.
  double motor_impulse = 0.0, limit_impulses[2] = {}, gear_impulse = 0.0;
};

// The step of all trees of a world: free motion, then the impulses of joints and contacts by
// projected Gauss-Seidel. The constraints and their targets are those of Bullet's
// btMultiBodyConstraintSolver, with friction cones and warm start. It takes the responses from
// TreeDynamics, skips the zeros of each row, and allocates nothing once its buffers have grown.
class CompactSolver {
 public:
  // Adds a tree, whose index is the user index of its colliders; `dynamics` must outlive the
  // solver.
  void AddTree(TreeDynamics* dynamics) { trees_.push_back({dynamics, {}}); }
  // Keeps the tree, whose joints a motor drives, and what is near it awake from now on, also after
  // the motor is released.
  void SetDriven(int tree) { trees_[static_cast<size_t>(tree)].driven = true; }
  // Puts trees to sleep that have been still for a fifth of a second, while whatever is near them
  // is still and not driven, and wakes the others. A tree that sleeps keeps its pose and its
  // contacts, and costs nothing. `dt`: s, of a step. `colliders`: by tree, those of the links that
  // move. `pairs`: of the broadphase, which come 4 cm before a contact.
  void PutToSleep(double dt, const std::vector<std::vector<btCollisionObject*>>& colliders,
                  btOverlappingPairCache* pairs);
  bool IsAsleep(int tree) const { return trees_[static_cast<size_t>(tree)].asleep; }
  void AddJoint(int tree, const SolverJoint& joint) {
    trees_[static_cast<size_t>(tree)].joints.push_back(joint);
  }

  // Drops the impulses of the tree's joints with which the next step would start: it has been
  // moved.
  void ForgetImpulses(int tree);

  // Advances all trees by `dt` (s) under `gravity` (m/s^2) and the contacts of `dispatcher`, whose
  // points keep their impulses for the next step.
  void Step(double dt, int iterations, const Eigen::Vector3d& gravity, btDispatcher* dispatcher);

 private:
  struct Tree {
    TreeDynamics* dynamics;
    std::vector<SolverJoint> joints;
    bool driven = false, asleep = false, may_sleep = false;
  };
  // A constraint on one coordinate of a tree.
  struct JointRow {
    double* velocity = nullptr;
    double sign = 1.0;
    const double* response = nullptr;
    double* changed = nullptr;
    int count = 0;
    double target = 0.0, inertia = 0.0, compliance = 0.0, lower = 0.0, upper = 0.0, impulse = 0.0;
    double* kept = nullptr;  // SolverJoint's impulse
  };
  // One body's side of a contact: where the contact's Jacobians are taken.
  struct Touch {
    TreeDynamics* dynamics = nullptr;  // none: it does not move
    int link = -1;
    double sign = 1.0;
    Eigen::Vector3d point;
  };
  struct Contact {
    Touch a, b;
    btManifoldPoint* point = nullptr;
  };
  // A normal's row for the warm start of the next step.
  struct Warm {
    btManifoldPoint* point = nullptr;
    double pull = 0.0;  // inertia times velocity error, Bullet's m_rhs
  };
  enum class Kind { kForce, kTorque };

  bool IsStill(const btCollisionObject& object) const;
  void AddMotor(double dt, TreeDynamics* dynamics, SolverJoint* joint);
  void AddLimits(double dt, TreeDynamics* dynamics, SolverJoint* joint);
  void AddGear(double dt, TreeDynamics* dynamics, SolverJoint* joint);
  static JointRow RowOf(int link, TreeDynamics* dynamics, double* kept);

  void Reserve(btDispatcher* dispatcher);
  double* Take(int count);
  Touch TouchOf(const btPersistentManifold& manifold, bool first) const;
  void AddContacts(btPersistentManifold* manifold, double dt);
  void AddNormal(const Contact& contact, double dt);
  void AddFriction(const Contact& contact);
  void AddTurningFriction(const Contact& contact, const Eigen::Vector3d (&directions)[2]);
  ConstraintRow MakeRow(const Contact& contact, const Eigen::Vector3d& direction, Kind kind);
  RowSide MakeSide(const Touch& touch, const Eigen::Vector3d& direction, Kind kind);
  void WarmStart();
  void Iterate(int iterations);
  void KeepImpulses();

  std::vector<Tree> trees_;
  int steps_to_sleep_ = 1;
  std::vector<double> numbers_;  // the Jacobians and responses of the rows
  size_t taken_ = 0;
  std::vector<JointRow> joints_;
  std::vector<ConstraintRow> gears_, normals_, frictions_, rollings_, spins_;
  std::vector<Warm> warm_;          // by row of normals_
  std::vector<double*> gear_kept_;  // by row of gears_: SolverJoint's impulse
};

}  // namespace simwright::sim
