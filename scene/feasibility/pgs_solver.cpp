#include "scene/feasibility/pgs_solver.h"

#include <algorithm>

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// The relaxation factor of each step. Any value below 2 converges (Cryer 1971).
constexpr double kOverRelaxation = 1.4;
constexpr int kActiveIterations = 10;  // over the active constraints, per iteration over all

// Projected Gauss-Seidel on the dual, constraint by constraint.
class ProjectedGaussSeidel {
 public:
  ProjectedGaussSeidel(const std::vector<char>& fixed, const PgsOptions& options,
                       std::vector<SeparationConstraint>* rows, std::vector<Vector3d>* shifts)
      : options_(options), rows_(*rows), shifts_(*shifts) {
    shifts_.assign(fixed.size(), Vector3d::Zero());
    for (const char body : fixed) inverse_mass_.push_back(body ? 0.0 : 1.0);
    for (const SeparationConstraint& row : rows_) ApplyImpulse(row, row.lambda);
  }

  // Iterates; returns the violation of the worst constraint, m.
  double Run() {
    for (int iteration = 0; iteration < options_.iterations; iteration += kActiveIterations) {
      active_.clear();
      largest_ = 0.0;
      for (size_t i = 0; i < rows_.size(); ++i) {
        SolveConstraint(&rows_[i]);
        if (rows_[i].lambda > 0.0) active_.push_back(i);
      }
      if (largest_ < options_.tolerance) break;
      bool bounded = true;
      for (int k = 1; k < kActiveIterations && largest_ >= options_.tolerance; ++k) {
        largest_ = 0.0;
        for (const size_t i : active_) SolveConstraint(&rows_[i]);
      }
      for (const size_t i : active_) bounded = bounded && rows_[i].lambda < options_.max_lambda;
      if (!bounded) break;
    }
    double worst = 0.0;
    for (const SeparationConstraint& row : rows_) {
      if (InverseMass(row) > 0.0) worst = std::max(worst, Violation(row));
    }
    return worst;
  }

 private:
  double InverseMass(const SeparationConstraint& row) const {
    return inverse_mass_[static_cast<size_t>(row.a)] + inverse_mass_[static_cast<size_t>(row.b)];
  }
  double Violation(const SeparationConstraint& row) const {
    return row.least - row.normal.dot(shifts_[static_cast<size_t>(row.b)] -
                                      shifts_[static_cast<size_t>(row.a)]);
  }
  void ApplyImpulse(const SeparationConstraint& row, double pressure) {
    const auto a = static_cast<size_t>(row.a), b = static_cast<size_t>(row.b);
    shifts_[a] -= (inverse_mass_[a] * pressure) * row.normal;
    shifts_[b] += (inverse_mass_[b] * pressure) * row.normal;
  }
  void SolveConstraint(SeparationConstraint* row) {
    const double inverse_mass = InverseMass(*row);
    if (inverse_mass == 0.0) return;
    const double before = row->lambda;
    const double step =
        (Violation(*row) - options_.compliance * before) / (inverse_mass + options_.compliance);
    row->lambda = std::max(0.0, before + kOverRelaxation * step);
    const double change = row->lambda - before;
    if (change == 0.0) return;
    ApplyImpulse(*row, change);
    largest_ = std::max(largest_, std::abs(change));
  }

  const PgsOptions& options_;
  std::vector<SeparationConstraint>& rows_;
  std::vector<Vector3d>& shifts_;
  std::vector<double> inverse_mass_;  // 1 or 0: inverse mass
  std::vector<size_t> active_;
  double largest_ = 0.0;  // largest change of a multiplier in an iteration, m
};

}  // namespace

double SolveLeastDisplacement(const std::vector<char>& fixed, const PgsOptions& options,
                              std::vector<SeparationConstraint>* rows,
                              std::vector<Vector3d>* shifts) {
  return ProjectedGaussSeidel(fixed, options, rows, shifts).Run();
}

}  // namespace simwright::scene
