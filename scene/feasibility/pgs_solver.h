#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::scene {

// A linear inequality constraint on the displacements of two bodies: normal . (shift_b - shift_a)
// >= least.
struct SeparationConstraint {
  int a = -1, b = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
  double least = 0.0;                                 // m
  double lambda = 0.0;  // m, >= 0: the multiplier; initial value and result
};

struct PgsOptions {
  // The largest violation of a constraint in the solution, m.
  double tolerance = 1e-7;
  // The constraint softness: infeasible constraints are violated by this share of their multiplier,
  // which bounds it; feasible ones by less than the tolerance, because their multipliers do not
  // exceed the displacements.
  double compliance = 1e-5;
  // m: a larger multiplier means infeasible constraints and ends the iteration. In a scene, the sum
  // of all multipliers on a body is smaller than this.
  double max_lambda = 5.0;
  int iterations = 2000;  // most iterations over the active constraints
};

// Computes the displacements (N x 3, m) with the least sum of squares that satisfy all constraints;
// those of `fixed` bodies are zero. Projected Gauss-Seidel on the dual (Hildreth 1957), as in
// contact solvers, with over-relaxation. Returns the violation of the worst constraint, m.
// Constraints between two fixed bodies are ignored.
double SolveLeastDisplacement(const std::vector<char>& fixed, const PgsOptions& options,
                              std::vector<SeparationConstraint>* rows,
                              std::vector<Eigen::Vector3d>* shifts);

}  // namespace simwright::scene
