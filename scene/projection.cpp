#include "scene/projection.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "core/error.h"
#include "scene/least_shift.h"
#include "scene/near_parts.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Of rows (LeastShiftOptions). Where rows contradict each other, whichever comes last has its way
// when they are stiff; soft, all of them share what is missing.
constexpr double kStiff = 1e-5, kSoft = 0.05;

using PartKey = std::tuple<int, int, int, int>;

PartKey KeyOf(const NearParts& near) {
  return {near.a, near.b, near.part_a, near.part_b};
}

class Rounds {
 public:
  Rounds(const std::vector<ProjectedBody>& bodies, const ProjectionOptions& options);
  Projection Run();

 private:
  bool Round(const std::vector<NearParts>& near, double compliance);
  void Keep(const std::vector<NearParts>& near, Projection* best) const;
  void TakeByHulls(const std::vector<NearParts>& near);
  std::vector<Overlap> OverlapsOf(const std::vector<NearParts>& near) const;
  void Search(std::vector<NearParts>* near) const;

  const ProjectionOptions& options_;
  ConvexBodies bodies_;
  std::vector<char> fixed_;
  std::vector<Vector3d> shifts_;
  std::map<PartKey, double> pressures_;  // m, of the last round
  std::set<std::pair<int, int>> by_hull_;
};

Rounds::Rounds(const std::vector<ProjectedBody>& bodies, const ProjectionOptions& options)
    : options_(options), shifts_(bodies.size(), Vector3d::Zero()) {
  for (const ProjectedBody& body : bodies) {
    if (!body.parts) throw core::Error("a body needs convex parts");
    bodies_.Add(*body.parts, body.world_from_body, body.fixed);
    fixed_.push_back(body.fixed);
  }
}

void Rounds::Search(std::vector<NearParts>* near) const {
  const auto by_hull = [&](int a, int b) { return by_hull_.count({a, b}) > 0; };
  bodies_.Find(shifts_, options_.influence, by_hull, near);
}

std::vector<Overlap> Rounds::OverlapsOf(const std::vector<NearParts>& near) const {
  std::vector<Overlap> overlaps;
  for (const NearParts& pair : near) {
    if (pair.distance >= -options_.tolerance) continue;
    const bool again =
        !overlaps.empty() && overlaps.back().a == pair.a && overlaps.back().b == pair.b;
    if (!again) overlaps.push_back({pair.a, pair.b, 0.0});
    overlaps.back().depth = std::max(overlaps.back().depth, -pair.distance);
  }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
  return overlaps;
}

// Those that are still in each other. Furniture that is fixed is not: its hull would push out
// what stands in it.
void Rounds::TakeByHulls(const std::vector<NearParts>& near) {
  for (const Overlap& overlap : OverlapsOf(near)) {
    const bool furniture = bodies_.fixed(overlap.a) || bodies_.fixed(overlap.b);
    if (!furniture) by_hull_.insert({overlap.a, overlap.b});
  }
}

// Whether any body still moves.
bool Rounds::Round(const std::vector<NearParts>& near, double compliance) {
  std::vector<SeparationRow> rows;
  rows.reserve(near.size());
  for (const NearParts& pair : near) {
    // d + n . (dp_b - dp_a) >= 0 with the shifts counted from the beginning.
    const Vector3d apart =
        shifts_[static_cast<size_t>(pair.b)] - shifts_[static_cast<size_t>(pair.a)];
    const auto last = pressures_.find(KeyOf(pair));
    rows.push_back({pair.a, pair.b, pair.normal, pair.normal.dot(apart) - pair.distance,
                    last == pressures_.end() ? 0.0 : last->second});
  }
  std::vector<Vector3d> shifts;
  LeastShiftOptions least;
  least.compliance = compliance;
  LeastShift(fixed_, least, &rows, &shifts);
  pressures_.clear();
  for (size_t i = 0; i < near.size(); ++i) {
    if (rows[i].pressure > 0.0) pressures_[KeyOf(near[i])] = rows[i].pressure;
  }
  double farthest = 0.0;
  for (size_t i = 0; i < shifts.size(); ++i) {
    farthest = std::max(farthest, (shifts[i] - shifts_[i]).norm());
  }
  shifts_ = std::move(shifts);
  return farthest > options_.settled;
}

// Where they are now, if that is no worse than what was the best.
void Rounds::Keep(const std::vector<NearParts>& near, Projection* best) const {
  const auto depth = [](const std::vector<Overlap>& overlaps) {
    return overlaps.empty() ? 0.0 : overlaps.front().depth;
  };
  std::vector<Overlap> overlaps = OverlapsOf(near);
  if (!best->shifts.empty() && depth(overlaps) > depth(best->overlaps)) return;
  best->shifts = shifts_;
  best->overlaps = std::move(overlaps);
}

Projection Rounds::Run() {
  Projection best;
  std::vector<NearParts> near;
  bool moves = true;
  for (;; ++best.rounds) {
    Search(&near);
    Keep(near, &best);
    const bool apart = OverlapsOf(near).empty();
    if (best.rounds == options_.rounds || (!moves && apart)) break;
    if (best.rounds >= options_.by_parts || !moves) TakeByHulls(near);
    moves = Round(near, kStiff);
  }
  if (!best.overlaps.empty()) {
    Round(near, kSoft);
    Search(&near);
    Keep(near, &best);
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
  if (by_parts < 1) return fails("by_parts has to be at least 1");
  return true;
}

Projection ProjectApart(const std::vector<ProjectedBody>& bodies,
                        const ProjectionOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("projection: " + error);
  return Rounds(bodies, options).Run();
}

}  // namespace simwright::scene
