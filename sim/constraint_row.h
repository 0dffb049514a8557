#pragma once

#include "sim/lanes.h"

namespace simwright::sim {

// One body's part of a constraint: where its Jacobian J and its response M^-1 J^T may differ from
// zero, and the body's velocities there. Counts are multiples of kLanes.
struct RowSide {
  const double* jacobian = nullptr;
  const double* velocity = nullptr;  // where the Jacobian begins
  const double* response = nullptr;
  double* changed = nullptr;  // the velocities where the response begins
  int jacobian_count = 0, response_count = 0;
};

// A constraint on the velocity J v of two bodies. Its impulse changes by (target - J v) inertia -
// compliance impulse, within the bounds.
struct ConstraintRow {
  RowSide a, b;
  double target = 0.0;   // rad/s or m/s
  double inertia = 0.0;  // effective, 1 / (J M^-1 J^T)
  double compliance = 0.0;
  double lower = 0.0, upper = 0.0, impulse = 0.0;
  double friction = 0.0;
  int normal = -1;  // of a friction row: the row of its contact's normal
};

// Returns J v of one side.
__attribute__((always_inline)) inline double Speed(const RowSide& side) {
  return Product(side.jacobian, side.velocity, side.jacobian_count);
}

__attribute__((always_inline)) inline void Apply(const RowSide& side, double impulse) {
  AddScaled(impulse, side.response, side.response_count, side.changed);
}

}  // namespace simwright::sim
