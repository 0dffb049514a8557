#include "scene/projection.h"

#include <algorithm>

#include "core/error.h"
#include "scene/least_shift.h"
#include "scene/near_parts.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Of rows (LeastShiftOptions). Where rows contradict each other, whichever comes last has its way
// when they are stiff; soft, all of them share what is missing.
constexpr double kStiff = 1e-6, kSoft = 0.05;

// Of the largest pressure: rows that contradict each other press about alike, others far less.
constexpr double kContradicting = 0.1;

class Rounds {
 public:
  Rounds(const std::vector<ProjectedBody>& bodies, const ProjectionOptions& options);
  Projection Run();

 private:
  bool Round(double compliance);
  void Keep(Projection* best) const;
  void TakeOtherWay();

  const ProjectionOptions& options_;
  ConvexBodies bodies_;
  std::vector<char> fixed_;
  SeparationPlanes planes_;
  std::vector<Vector3d> shifts_;
  std::vector<std::pair<int, int>> contradicting_;  // free bodies of the last round
};

Rounds::Rounds(const std::vector<ProjectedBody>& bodies, const ProjectionOptions& options)
    : options_(options),
      planes_(&bodies_, {options.influence, options.tolerance}),
      shifts_(bodies.size(), Vector3d::Zero()) {
  for (const ProjectedBody& body : bodies) {
    if (!body.parts) throw core::Error("a body needs convex parts");
    bodies_.Add(*body.parts, body.world_from_body, body.fixed);
    fixed_.push_back(body.fixed);
  }
}

// Where ways out contradict each other: all of them by hulls, as the parts of hollow things may
// leave each other no way; else one of them, where that is the nearest, across the shallowest way.
// Furniture is let be: its hull would push out what stands in it.
void Rounds::TakeOtherWay() {
  bool taken = false;
  for (const auto& [a, b] : contradicting_) taken = planes_.TakeByHull(a, b) || taken;
  if (!taken) planes_.TurnOneAcross(contradicting_, shifts_);
  planes_.Update(shifts_);
}

// Whether any body still moves.
bool Rounds::Round(double compliance) {
  std::vector<SeparationRow> rows = planes_.Rows();
  std::vector<Vector3d> shifts;
  LeastShiftOptions least;
  least.compliance = compliance;
  const double missing = LeastShift(fixed_, least, &rows, &shifts);
  contradicting_.clear();
  if (missing > options_.tolerance) {
    double largest = 0.0;
    for (const SeparationRow& row : rows) largest = std::max(largest, row.pressure);
    for (SeparationRow& row : rows) {
      const bool free = !bodies_.fixed(row.a) && !bodies_.fixed(row.b);
      if (free && row.pressure > kContradicting * largest)
        contradicting_.emplace_back(row.a, row.b);
      row.pressure = 0.0;  // they have grown without bound: nowhere to begin
    }
  }
  planes_.SetPressures(rows);
  double farthest = 0.0;
  for (size_t i = 0; i < shifts.size(); ++i) {
    farthest = std::max(farthest, (shifts[i] - shifts_[i]).norm());
  }
  shifts_ = std::move(shifts);
  return farthest > options_.settled;
}

// Where they are now, if that is no worse than what was the best.
void Rounds::Keep(Projection* best) const {
  const auto depth = [](const std::vector<Overlap>& overlaps) {
    return overlaps.empty() ? 0.0 : overlaps.front().depth;
  };
  std::vector<Overlap> overlaps = planes_.Overlaps();
  if (!best->shifts.empty() && depth(overlaps) > depth(best->overlaps)) return;
  best->shifts = shifts_;
  best->overlaps = std::move(overlaps);
}

Projection Rounds::Run() {
  Projection best;
  bool moves = true;
  for (;; ++best.rounds) {
    planes_.Update(shifts_);
    Keep(&best);
    const bool apart = planes_.Overlaps().empty();
    if (best.rounds == options_.rounds || (!moves && apart)) break;
    if (!contradicting_.empty()) TakeOtherWay();
    moves = Round(kStiff);
  }
  if (!best.overlaps.empty()) {
    Round(kSoft);
    planes_.Update(shifts_);
    Keep(&best);
  }
  best.feasible = best.overlaps.empty();
  for (const Vector3d& shift : best.shifts) best.cost += shift.squaredNorm();
  return best;
}

}  // namespace

bool ProjectionOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(influence > 0.0)) return fails("influence has to be above 0 m");
  if (!(tolerance > 0.0)) return fails("tolerance has to be above 0 m");
  if (!(settled > 0.0)) return fails("settled has to be above 0 m");
  if (rounds < 1) return fails("rounds has to be at least 1");
  return true;
}

Projection ProjectApart(const std::vector<ProjectedBody>& bodies,
                        const ProjectionOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("projection: " + error);
  return Rounds(bodies, options).Run();
}

}  // namespace simwright::scene
