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

constexpr int kInfeasibleRounds = 4;  // with alternative planes, before a relation is given up

class ProjectionSolver {
 public:
  ProjectionSolver(const std::vector<ProjectedBody>& bodies, const DepenetrationOptions& options,
                   const std::vector<KeptRelation>& relations);
  Projection Run();

 private:
  void StartFromRelations();
  Projection RunRounds();
  bool SolveRound(double compliance);
  void AddRelationRows(std::vector<SeparationConstraint>* rows);
  void KeepMultipliers(const std::vector<SeparationConstraint>& rows, size_t contacts);
  bool GiveUpMostStrained(const std::vector<SeparationConstraint>& rows, size_t contacts,
                          double largest);
  void KeepBest(Projection* best) const;
  void TryAlternativePlanes();
  bool SwitchToRelationNormals();

  const DepenetrationOptions& options_;
  ConvexBodies bodies_;
  std::vector<char> fixed_;
  ContactPlanes planes_;
  std::vector<Vector3d> shifts_;
  std::vector<std::pair<int, int>> infeasible_;  // pairs of free bodies of the last round
  const std::vector<KeptRelation>& relations_;
  std::vector<std::vector<SeparationConstraint>> relation_rows_;  // (relations)
  std::vector<char> given_up_;                                    // (relations)
  std::vector<size_t> relation_of_;  // the relation of each row behind those of contacts
  int infeasible_rounds_ = 0;        // consecutive ones
};

ProjectionSolver::ProjectionSolver(const std::vector<ProjectedBody>& bodies,
                                   const DepenetrationOptions& options,
                                   const std::vector<KeptRelation>& relations)
    : options_(options),
      planes_(&bodies_, {options.contact_margin, options.tolerance}),
      shifts_(bodies.size(), Vector3d::Zero()),
      relations_(relations),
      given_up_(relations.size(), 0) {
  const auto count = static_cast<int>(bodies.size());
  for (const KeptRelation& kept : relations) {
    const auto exists = [&](int body) { return body >= 0 && body < count; };
    if (!exists(kept.subject) || !exists(kept.object) || kept.subject == kept.object) {
      throw core::Error("a relation needs two bodies");
    }
    relation_rows_.push_back(LinearizeRelation(kept));
    const auto [a, b] = std::minmax(kept.subject, kept.object);
    if (IsInCavity(kept)) planes_.KeepParts(a, b);
  }
  for (const ProjectedBody& body : bodies) {
    if (!body.parts) throw core::Error("a body needs convex parts");
    bodies_.Add(*body.parts, body.world_from_body, body.fixed);
    fixed_.push_back(body.fixed);
  }
}

// Separates the infeasible pairs that a relation is asked of in the direction of the relation.
// Returns false if there is none.
bool ProjectionSolver::SwitchToRelationNormals() {
  bool switched = false;
  for (size_t i = 0; i < relations_.size(); ++i) {
    const KeptRelation& kept = relations_[i];
    const std::pair<int, int> pair = std::minmax(kept.subject, kept.object);
    const bool is_infeasible =
        std::find(infeasible_.begin(), infeasible_.end(), pair) != infeasible_.end();
    const auto direction = SeparatingDirection(kept);
    if (given_up_[i] || !is_infeasible || !direction) continue;
    const double sign = pair.second == kept.subject ? 1.0 : -1.0;
    switched =
        planes_.SwitchToNormal(pair.first, pair.second, sign * *direction, shifts_) || switched;
  }
  return switched;
}

// Handles pairs whose constraints are infeasible: represents all of them by hulls, since the parts
// of hollow bodies may admit no separation; if they already are, gives the pair of least lateral
// depth a normal that a relation asks for, or else a lateral one. Furniture keeps its parts: its
// hull would push out the objects inside.
void ProjectionSolver::TryAlternativePlanes() {
  bool taken = false;
  for (const auto& [a, b] : infeasible_) taken = planes_.UseConvexHull(a, b) || taken;
  if (!taken && !SwitchToRelationNormals()) planes_.SwitchToLateralNormal(infeasible_, shifts_);
  planes_.Update(shifts_);
}

void ProjectionSolver::AddRelationRows(std::vector<SeparationConstraint>* rows) {
  relation_of_.clear();
  for (size_t i = 0; i < relations_.size(); ++i) {
    if (given_up_[i]) continue;
    rows->insert(rows->end(), relation_rows_[i].begin(), relation_rows_[i].end());
    relation_of_.insert(relation_of_.end(), relation_rows_[i].size(), i);
  }
}

// Keeps the multipliers of the relations' rows, behind those of the contacts, for the next round.
void ProjectionSolver::KeepMultipliers(const std::vector<SeparationConstraint>& rows,
                                       size_t contacts) {
  size_t next = contacts;
  for (size_t i = 0; i < relations_.size(); ++i) {
    if (given_up_[i]) {  // perhaps in this round
      if (next < rows.size() && relation_of_[next - contacts] == i)
        next += relation_rows_[i].size();
      continue;
    }
    for (SeparationConstraint& row : relation_rows_[i]) row.lambda = rows[next++].lambda;
  }
}

// Gives up the relation with the largest multiplier of infeasible constraints; returns false if
// none has a large one.
bool ProjectionSolver::GiveUpMostStrained(const std::vector<SeparationConstraint>& rows,
                                          size_t contacts, double largest) {
  double most = kInfeasibleShare * largest;
  size_t strained = relations_.size();
  for (size_t i = contacts; i < rows.size(); ++i) {
    if (rows[i].lambda <= most) continue;
    most = rows[i].lambda;
    strained = relation_of_[i - contacts];
  }
  if (strained == relations_.size()) return false;
  given_up_[strained] = 1;
  const auto [a, b] = std::minmax(relations_[strained].subject, relations_[strained].object);
  planes_.ReleaseParts(a, b);
  return true;
}

// Solves one round; returns true if a body still moves.
bool ProjectionSolver::SolveRound(double compliance) {
  std::vector<SeparationConstraint> rows = planes_.Rows();
  const size_t contacts = rows.size();
  AddRelationRows(&rows);
  std::vector<Vector3d> shifts;
  PgsOptions least;
  least.compliance = compliance;
  const double violation = SolveLeastDisplacement(fixed_, least, &rows, &shifts);
  infeasible_.clear();
  if (violation > options_.tolerance) {
    double largest = 0.0;
    for (const SeparationConstraint& row : rows) largest = std::max(largest, row.lambda);
    // Other planes of the same contacts may mend a round (TryAlternativePlanes): relations are
    // given up after several infeasible rounds only.
    if (++infeasible_rounds_ > kInfeasibleRounds && GiveUpMostStrained(rows, contacts, largest)) {
      infeasible_rounds_ = 0;
    }
    for (size_t i = 0; i < rows.size(); ++i) {
      SeparationConstraint& row = rows[i];
      const bool free = !bodies_.fixed(row.a) && !bodies_.fixed(row.b);
      const bool strained = row.lambda > kInfeasibleShare * largest;
      if (i < contacts && free && strained) infeasible_.emplace_back(row.a, row.b);
      row.lambda = 0.0;  // unbounded, so no initial value
    }
  } else {
    infeasible_rounds_ = 0;
  }
  KeepMultipliers(rows, contacts);
  rows.resize(contacts);
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
  if (!relations_.empty()) StartFromRelations();
  Projection best = RunRounds();
  const bool keeps = std::find(given_up_.begin(), given_up_.end(), 0) != given_up_.end();
  if (!best.overlaps.empty() && keeps) {  // no collision is the price of a relation
    std::fill(given_up_.begin(), given_up_.end(), 1);
    for (const KeptRelation& kept : relations_) {
      const auto [a, b] = std::minmax(kept.subject, kept.object);
      planes_.ReleaseParts(a, b);
    }
    const int rounds = best.rounds;
    best = RunRounds();
    best.rounds += rounds;
  }
  best.feasible = best.overlaps.empty();
  for (const Vector3d& shift : best.shifts) best.cost += shift.squaredNorm();
  for (size_t i = 0; i < relations_.size(); ++i) {
    if (!HoldsAfter(relations_[i], best.shifts)) best.broken.push_back(static_cast<int>(i));
  }
  return best;
}

// Displaces the bodies so that the relations hold, collisions aside: there the contacts are
// linearised first, so that bodies part on the sides that the relations ask for.
void ProjectionSolver::StartFromRelations() {
  std::vector<SeparationConstraint> rows;
  AddRelationRows(&rows);
  std::vector<Vector3d> shifts;
  const double violation = SolveLeastDisplacement(fixed_, {}, &rows, &shifts);
  // Contradictory relations would displace bodies without bound.
  if (violation <= options_.tolerance) shifts_ = std::move(shifts);
}

Projection ProjectionSolver::RunRounds() {
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
                               const DepenetrationOptions& options,
                               const std::vector<KeptRelation>& relations) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("projection: " + error);
  return ProjectionSolver(bodies, options, relations).Run();
}

}  // namespace simwright::scene
