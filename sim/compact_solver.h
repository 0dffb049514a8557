#pragma once

#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

namespace simwright::sim {

// Bullet's solver of jointed bodies with its iterations done anew; rows, their order and what they
// ask for are Bullet's. Bullet multiplies each row by all of a body's velocities, the base's also
// where it is held, changes them twice a row (in the solver and in the body) and finds a friction
// cone by its angle. Here a row knows which of its numbers are not zero, and bodies get their
// velocities once, at the end. For worlds without rigid bodies that move.
class CompactSolver : public btMultiBodyConstraintSolver {
 public:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                        btPersistentManifold** manifolds, int manifold_count,
                                        btTypedConstraint** constraints, int constraint_count,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* drawer) override;
  // Returns the sum of squares of the changes of impulses, (N s)^2 or (N m s)^2.
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  // What a row reads and changes of one body: `count` numbers from the first that is not zero on.
  struct Side {
    const double* jacobian = nullptr;
    const double* velocity = nullptr;  // changes of velocity that the jacobian reads
    const double* response = nullptr;  // to an impulse of 1
    double* changed = nullptr;         // the velocities that it changes
    int jacobian_count = 0, response_count = 0;
  };
  struct Row {
    Side a, b;
    double rhs = 0.0, inertia = 0.0, compliance = 0.0;  // as btMultiBodySolverConstraint's
    double lower = 0.0, upper = 0.0, impulse = 0.0;
    double friction = 0.0;
    int normal = -1;  // of a friction's contact, in normals_
  };
  struct Moved {
    btMultiBody* body = nullptr;
    int first = 0;  // in m_data.m_deltaVelocities
  };

  void Pack(const btMultiBodyConstraintArray& source, std::vector<Row>* rows);
  Side PackSide(btMultiBody* body, int jacobian, int velocity);
  static void WriteBack(const std::vector<Row>& rows, btMultiBodyConstraintArray* target);
  static double Wanted(const Row& row);
  static double Change(double change, Row* row);
  static double Solve(Row* row);
  double SolveSpins();
  // `pressed_only`: as Bullet, a rolling friction keeps its impulse while nothing presses.
  double SolveCones(bool pressed_only, std::vector<Row>* rows);

  std::vector<Row> joints_, normals_, frictions_, rollings_, spins_;
  std::vector<Moved> moved_;
  std::vector<double> before_;  // m_data.m_deltaVelocities before the first iteration
};

}  // namespace simwright::sim
