#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::scene {

// One linear inequality on the shifts of two bodies: normal . (shift_b - shift_a) >= least.
struct SeparationRow {
  int a = -1, b = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
  double least = 0.0;                                 // m
  double pressure = 0.0;  // m, at least 0: the multiplier; where to begin, and what was found
};

struct LeastShiftOptions {
  // m that a row may be short of once it is solved.
  double tolerance = 1e-7;
  // Rows that contradict each other are short by this share of their pressure in place of growing
  // without bound; others by less than the tolerance, as pressures are no more than what moved.
  double compliance = 1e-5;
  // m: a pressure above it is of rows that contradict each other, which ends the search. What is
  // moved by the sum of all that presses on it, in a scene, is moved by less.
  double unbounded = 5.0;
  int sweeps = 2000;  // at most, over the rows that press
};

// The shifts (N x 3, m) with the least sum of squares that all rows allow; of bodies that are
// `fixed` they are zero. Each row in turn takes the pressure that closes it (Hildreth 1957, which
// is Gauss and Seidel on the dual), as contact solvers do, and somewhat more of it (over-relaxed).
// Returns by how much the worst row is short, m. Rows between two fixed bodies are left out.
double LeastShift(const std::vector<char>& fixed, const LeastShiftOptions& options,
                  std::vector<SeparationRow>* rows, std::vector<Eigen::Vector3d>* shifts);

}  // namespace simwright::scene
