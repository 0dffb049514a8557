#pragma once

#include <memory>

class btMultiBodyConstraintSolver;

namespace simwright::sim {

// Bullet's solver of jointed bodies with its iterations done anew; rows, their order and what they
// ask for are Bullet's. Bullet multiplies each row by all of a body's velocities, the base's also
// where it is held, changes them twice a row (in the solver and in the body) and finds a friction
// cone by its angle. Here a row knows which of its numbers are not zero, and bodies get their
// velocities once, at the end. For worlds without rigid bodies that move.
std::unique_ptr<btMultiBodyConstraintSolver> MakeCompactSolver();

}  // namespace simwright::sim
