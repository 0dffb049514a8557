#pragma once

#include <memory>

class btMultiBodyConstraintSolver;

namespace simwright::sim {

// Creates Bullet's solver of articulated bodies with faster iterations; the constraint rows, their
// order and their targets are Bullet's. Bullet multiplies each row by all velocities of a body,
// including a fixed base's, updates them twice per row (in the solver and in the body) and computes
// a friction cone by its angle. This solver skips the zeros of each row and updates the bodies
// once, at the end. For worlds without moving rigid bodies.
std::unique_ptr<btMultiBodyConstraintSolver> MakeCompactSolver();

}  // namespace simwright::sim
