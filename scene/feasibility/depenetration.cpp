#include "scene/feasibility/depenetration.h"

#include <algorithm>

#include "core/error.h"
#include "scene/feasibility/contact_planes.h"
#include "scene/feasibility/narrow_phase.h"
#include "scene/feasibility/pgs_solver.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Constraint softness (PgsOptions). Among infeasible stiff constraints the last one
// prevails; soft ones share the violation.
constexpr double kStiff = 1e-6, kSoft = 0.05;

// A share of the largest multiplier: infeasible constraints have similar multipliers, others far
// smaller ones.
constexpr double kInfeasibleShare = 0.1;

class ProjectionSolver {
 public:
  ProjectionSolver(const std::vector<ProjectedBody>& bodies, const DepenetrationOptions& options);
  Projection Run();

 private:
  bool SolveRound(double compliance);
  void KeepBest(Projection* best) const;
  void TryAlternativePlanes();

  const DepenetrationOptions& options_;
  ConvexBodies bodies_;
  std::vector<char> fixed_;
  ContactPlanes planes_;
  std::vector<Vector3d> shifts_;
  std::vector<std::pair<int, int>> infeasible_;  // pairs of free bodies of the last round
};

ProjectionSolver::ProjectionSolver(const std::vector<ProjectedBody>& bodies,
                                   const DepenetrationOptions& options)
    : options_(options),
      planes_(&bodies_, {options.contact_margin, options.tolerance}),
      shifts_(bodies.size(), Vector3d::Zero()) {
  for (const ProjectedBody& body : bodies) {
    if (!body.parts) throw core::Error("a body needs convex parts");
    bodies_.Add(*body.parts, body.world_from_body, body.fixed);
    fixed_.push_back(body.fixed);
  }
}

// Handles pairs whose constraints are infeasible: represents all of them by hulls, since the parts
// of hollow bodies may admit no separation; if they already are, gives the pair of least lateral
// depth a lateral normal. Furniture keeps its parts: its hull would push out the objects inside.
void ProjectionSolver::TryAlternativePlanes() {
  bool taken = false;
  for (const auto& [a, b] : infeasible_) taken = planes_.UseConvexHull(a, b) || taken;
  if (!taken) planes_.SwitchToLateralNormal(infeasible_, shifts_);
  planes_.Update(shifts_);
}

// Solves one round; returns true if a body still moves.
bool ProjectionSolver::SolveRound(double compliance) {
  std::vector<SeparationConstraint> rows = planes_.Rows();
  std::vector<Vector3d> shifts;
  PgsOptions least;
  least.compliance = compliance;
  const double violation = SolveLeastDisplacement(fixed_, least, &rows, &shifts);
  infeasible_.clear();
  if (violation > options_.tolerance) {
    double largest = 0.0;
    for (const SeparationConstraint& row : rows) largest = std::max(largest, row.lambda);
    for (SeparationConstraint& row : rows) {
      const bool free = !bodies_.fixed(row.a) && !bodies_.fixed(row.b);
      if (free && row.lambda > kInfeasibleShare * largest) infeasible_.emplace_back(row.a, row.b);
      row.lambda = 0.0;  // unbounded, so no initial value
    }
  }
  planes_.SetMultipliers(rows);
  double farthest = 0.0;
  for (size_t i = 0; i < shifts.size(); ++i) {
    farthest = std::max(farthest, (shifts[i] - shifts_[i]).norm());
  }
  shifts_ = std::move(shifts);
  return farthest > options_.settled;
}

// Keeps the current displacements if they are no worse than the best ones.
void ProjectionSolver::KeepBest(Projection* best) const {
  const auto depth = [](const std::vector<Overlap>& overlaps) {
    return overlaps.empty() ? 0.0 : overlaps.front().depth;
  };
  std::vector<Overlap> overlaps = planes_.Overlaps();
  if (!best->shifts.empty() && depth(overlaps) > depth(best->overlaps)) return;
  best->shifts = shifts_;
  best->overlaps = std::move(overlaps);
}

Projection ProjectionSolver::Run() {
  Projection best;
  bool moves = true;
  for (;; ++best.rounds) {
    planes_.Update(shifts_);
    KeepBest(&best);
    const bool apart = planes_.Overlaps().empty();
    if (best.rounds == options_.rounds || (!moves && apart)) break;
    if (!infeasible_.empty()) TryAlternativePlanes();
    moves = SolveRound(kStiff);
  }
  if (!best.overlaps.empty()) {
    SolveRound(kSoft);
    planes_.Update(shifts_);
    KeepBest(&best);
  }
  best.feasible = best.overlaps.empty();
  for (const Vector3d& shift : best.shifts) best.cost += shift.squaredNorm();
  return best;
}

}  // namespace

bool DepenetrationOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(contact_margin > 0.0)) return fails("influence must be above 0 m");
  if (!(tolerance > 0.0)) return fails("tolerance must be above 0 m");
  if (!(settled > 0.0)) return fails("settled must be above 0 m");
  if (rounds < 1) return fails("rounds must be at least 1");
  return true;
}

Projection ResolvePenetrations(const std::vector<ProjectedBody>& bodies,
                               const DepenetrationOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("projection: " + error);
  return ProjectionSolver(bodies, options).Run();
}

}  // namespace simwright::scene
