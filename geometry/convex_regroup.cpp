#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_pieces.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using CellSet = std::vector<int>;  // ascending

constexpr double kLargeGain = 0.93;  // a change must lower the concavity to at most this share
constexpr double kSmallGain = 0.98;
constexpr int kChain = 12;            // groups through which a surplus may be passed on
constexpr int kCellsPerPart = 12;     // most cells after refinement
constexpr int kOutlineVertices = 64;  // of a hull that is measured, as of a part that is returned
constexpr double kElongation = 0.9;   // ratio of variances below which a direction is distinct
constexpr double kSameHeight = 1e-5;  // of the diagonal

CellSet Without(const CellSet& set, const CellSet& removed) {
  CellSet rest;
  std::set_difference(set.begin(), set.end(), removed.begin(), removed.end(),
                      std::back_inserter(rest));
  return rest;
}

CellSet With(const CellSet& set, const CellSet& added) {
  CellSet all;
  std::set_union(set.begin(), set.end(), added.begin(), added.end(), std::back_inserter(all));
  return all;
}

class Regrouping {
 public:
  Regrouping(const CutContext& context, int evaluations, std::vector<Piece>* cells,
             const std::vector<Piece>& parts)
      : context_(context), cells_(*cells) {
    AddCells(0);
    for (const Piece& part : parts) {
      CellSet set = part.cells;
      std::sort(set.begin(), set.end());
      groups_.push_back(std::move(set));
    }
    Measure(groups_, std::numeric_limits<double>::infinity());
    for (const CellSet& set : groups_) cost_.push_back(CostOf(set));
    budget_ = evaluations;
    most_cells_ = std::max<int>(cells_.size(), kCellsPerPart * parts.size());
    UpdateOwners();
  }

  // Improves the most concave group again and again, first by large steps, then by small ones.
  void Run() {
    for (const double gain : {kLargeGain, kSmallGain}) {
      std::vector<char> settled(groups_.size(), 0);
      while (budget_ > 0) {
        core::CheckCancelled();
        int worst = -1;
        for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
          if (!settled[g] && (worst < 0 || cost_[g] > cost_[worst])) worst = g;
        }
        if (worst < 0 || cost_[worst] <= context_.options->threshold) break;
        changed_.clear();
        if (Improve(worst, gain)) {
          for (const int g : changed_) settled[g] = 0;
        } else {
          settled[worst] = 1;
        }
      }
    }
  }

  std::vector<Piece> Parts() const {
    std::vector<Piece> parts;
    for (const CellSet& group : groups_) {
      parts.push_back(cells_[group[0]]);
      for (std::size_t i = 1; i < group.size(); ++i) {
        parts.back() = JoinedPiece(parts.back(), cells_[group[i]], context_);
      }
      parts.back().cells = group;
    }
    return parts;
  }

 private:
  struct Known {
    double cost = 0.0;
    bool exact = false;  // otherwise a lower bound
  };
  using Plan = std::map<int, CellSet>;  // new cells of some groups

  double Concavity(const CellSet& set, double enough) const {
    std::vector<Vector3d> points;
    double volume = 0.0;
    for (const int c : set) {
      points.insert(points.end(), outlines_[c].begin(), outlines_[c].end());
      volume += cells_[c].volume;
    }
    const double thickness = context_.options->min_thickness * context_.diagonal;
    return context_.fit->Concavity(ThickenedConvexHull(points, thickness, kOutlineVertices), volume,
                                   enough);
  }

  // Measures the concavities of `sets` in parallel, as far as they are not known to be above
  // `enough`.
  void Measure(std::vector<CellSet> sets, double enough) {
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    std::erase_if(sets, [&](const CellSet& set) {
      const auto known = known_.find(set);
      return known != known_.end() && (known->second.exact || known->second.cost > enough);
    });
    std::vector<double> cost(sets.size());
    core::ParallelFor(static_cast<int>(sets.size()),
                      [&](int i) { cost[i] = Concavity(sets[i], enough); });
    for (std::size_t i = 0; i < sets.size(); ++i) known_[sets[i]] = {cost[i], cost[i] <= enough};
    budget_ -= static_cast<int>(sets.size());
  }

  double CostOf(const CellSet& set) const { return known_.at(set).cost; }

  // Prepares the cells from `first` on: their outlines and neighbours.
  void AddCells(int first) {
    const int n = static_cast<int>(cells_.size());
    neighbours_.resize(n);
    outlines_.resize(n);
    std::vector<std::vector<int>> found(n);
    core::ParallelFor(n - first, [&](int i) {
      outlines_[first + i] = cells_[first + i].hull.vertices;
      if (outlines_[first + i].size() > kOutlineVertices) {
        outlines_[first + i] = ConvexHull(outlines_[first + i], kOutlineVertices).vertices;
      }
      for (int j = 0; j < first + i; ++j) {
        if (cells_[j].hull.empty()) continue;
        if (AreNeighbours(cells_[first + i], cells_[j], context_)) found[first + i].push_back(j);
      }
    });
    for (int i = first; i < n; ++i) {
      for (const int j : found[i]) {
        neighbours_[i].push_back(j);
        neighbours_[j].push_back(i);
      }
    }
  }

  void UpdateOwners() {
    owner_.assign(cells_.size(), -1);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (const int c : groups_[g]) owner_[c] = static_cast<int>(g);
    }
  }

  // Returns the groups that touch `set`, other than `self`.
  std::vector<int> GroupsAt(const CellSet& set, int self) const {
    std::vector<int> groups;
    for (const int c : set) {
      for (const int d : neighbours_[c]) {
        if (owner_[d] >= 0 && owner_[d] != self) groups.push_back(owner_[d]);
      }
    }
    std::sort(groups.begin(), groups.end());
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    return groups;
  }

  // Returns the subsets of `set` that a plane across the axes or along its extent separates.
  std::vector<CellSet> Halves(const CellSet& set) const {
    std::vector<Vector3d> middles;
    Vector3d mean = Vector3d::Zero();
    for (const int c : set) {
      middles.push_back(core::Bounds(cells_[c].hull).center());
      mean += middles.back() / static_cast<double>(set.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& m : middles) spread += (m - mean) * (m - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    std::vector<Vector3d> axes{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    if (solver.eigenvalues()[1] < kElongation * solver.eigenvalues()[2]) {
      axes.push_back(solver.eigenvectors().col(2));
    }
    std::vector<CellSet> halves;
    for (const Vector3d& axis : axes) {
      std::vector<std::pair<long, int>> order;  // heights in small steps: ties go by number
      for (std::size_t i = 0; i < set.size(); ++i) {
        const double height = axis.dot(middles[i]) / (kSameHeight * context_.diagonal);
        order.emplace_back(std::lround(height), set[i]);
      }
      std::sort(order.begin(), order.end());
      CellSet half;
      for (std::size_t k = 0; k + 1 < order.size(); ++k) {
        const int cell = order[k].second;
        half.insert(std::upper_bound(half.begin(), half.end(), cell), cell);
        halves.push_back(half);
        halves.push_back(Without(set, half));
      }
    }
    std::sort(halves.begin(), halves.end());
    halves.erase(std::unique(halves.begin(), halves.end()), halves.end());
    return halves;
  }

  // Returns the subsets of `set` that may be handed on: single cells and halves.
  std::vector<CellSet> Surpluses(const CellSet& set) const {
    std::vector<CellSet> all = Halves(set);
    if (set.size() > 1) {
      for (const int c : set) all.push_back({c});
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  // Lowers the concavity of `group` without raising another's to it. Cheap changes come first.
  bool Improve(int group, double gain) {
    const double limit = gain * cost_[group];
    Plan plan;
    for (int round = 0; round < 3 && budget_ > 0; ++round) {
      if (HandOn(group, limit, 1, &plan) || SplitAndMerge(group, limit, &plan)) {
        return Apply(plan);
      }
      if (!RefineCells(group)) break;
    }
    if (budget_ > 0 && HandOn(group, limit, kChain, &plan)) return Apply(plan);
    return false;
  }

  bool Apply(const Plan& plan) {
    for (const auto& [g, set] : plan) {
      groups_[g] = set;
      cost_[g] = CostOf(set);
      changed_.push_back(g);
    }
    UpdateOwners();
    return true;
  }

  struct Offer {
    CellSet rest, grown;
    int receiver;
    double cost = 0.0;
  };

  // Returns the surpluses of `set`, the new cells of `group`, that leave it at most `limit`, each
  // with a touching group that is not in `plan` and could take it, least concave first.
  std::vector<Offer> Offers(int group, const CellSet& set, double limit, const Plan& plan) {
    std::vector<CellSet> rests;
    const std::vector<CellSet> surpluses = Surpluses(set);
    for (const CellSet& surplus : surpluses) rests.push_back(Without(set, surplus));
    Measure(rests, limit);
    std::vector<Offer> offers;
    std::vector<CellSet> growns;
    for (std::size_t i = 0; i < surpluses.size(); ++i) {
      if (CostOf(rests[i]) > limit) continue;
      for (const int receiver : GroupsAt(surpluses[i], group)) {
        if (plan.contains(receiver)) continue;
        offers.push_back({rests[i], With(groups_[receiver], surpluses[i]), receiver});
        growns.push_back(offers.back().grown);
      }
    }
    // The bounds of unsuitable receivers rank them, hence some slack.
    Measure(growns, 1.5 * limit);
    for (Offer& offer : offers) offer.cost = CostOf(offer.grown);
    std::stable_sort(offers.begin(), offers.end(),
                     [](const Offer& a, const Offer& b) { return a.cost < b.cost; });
    return offers;
  }

  // Finds a surplus of `group` that a touching group can take below `limit`, or can after it has
  // handed on a surplus of its own without becoming more concave than it is. Searches breadth first
  // over at most `most` groups.
  bool HandOn(int group, double limit, int most, Plan* plan) {
    struct Step {
      int group;
      CellSet set;
      Plan plan;
    };
    std::vector<Step> steps{{group, groups_[group], {}}};
    std::vector<char> reached(groups_.size(), 0);
    reached[group] = 1;
    for (int i = 0; i < most && i < static_cast<int>(steps.size()) && budget_ > 0; ++i) {
      const Step step = steps[i];
      const double rest_limit = i == 0 ? limit : std::max(limit, cost_[step.group]);
      for (const Offer& offer : Offers(step.group, step.set, rest_limit, step.plan)) {
        const bool taken = offer.cost <= limit;
        if (!taken && reached[offer.receiver]) continue;
        reached[offer.receiver] = 1;
        Step next{offer.receiver, offer.grown, step.plan};
        next.plan[step.group] = offer.rest;
        if (taken) {
          next.plan[offer.receiver] = offer.grown;
          *plan = std::move(next.plan);
          return true;
        }
        steps.push_back(std::move(next));
      }
    }
    return false;
  }

  // Splits `group` in two and merges two others, all below `limit`.
  bool SplitAndMerge(int group, double limit, Plan* plan) {
    const std::vector<CellSet> halves = Halves(groups_[group]);
    Measure(halves, limit);
    const CellSet* best = nullptr;
    double least = limit;
    for (const CellSet& half : halves) {
      if (CostOf(half) > least) continue;
      const double cost = std::max(CostOf(half), CostOf(Without(groups_[group], half)));
      if (cost > least || (best && cost == least)) continue;
      least = cost;
      best = &half;
    }
    if (!best) return false;
    std::vector<std::pair<int, int>> pairs;
    std::vector<CellSet> merged;
    for (int a = 0; a < static_cast<int>(groups_.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(groups_.size()); ++b) {
        if (a == group || b == group) continue;
        pairs.emplace_back(a, b);
        merged.push_back(With(groups_[a], groups_[b]));
      }
    }
    Measure(merged, limit);
    int chosen = -1;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (CostOf(merged[i]) > limit) continue;
      if (chosen < 0 || CostOf(merged[i]) < CostOf(merged[chosen])) chosen = static_cast<int>(i);
    }
    if (chosen < 0) return false;
    (*plan)[group] = *best;
    (*plan)[pairs[chosen].first] = merged[chosen];
    (*plan)[pairs[chosen].second] = Without(groups_[group], *best);
    return true;
  }

  // Cuts the cells of `group` in two where they are large enough; false if none is.
  bool RefineCells(int group) {
    CellSet refined;
    bool cut_any = false;
    const int before = static_cast<int>(cells_.size());
    for (const int c : groups_[group]) {
      std::vector<Piece> halves;
      if (static_cast<int>(cells_.size()) < most_cells_) halves = CutCell(cells_[c]);
      if (halves.empty()) {
        refined.push_back(c);
        continue;
      }
      cut_any = true;
      cells_[c] = Piece();  // used by no group any more
      for (int other : neighbours_[c]) std::erase(neighbours_[other], c);
      neighbours_[c].clear();
      for (Piece& half : halves) {
        refined.push_back(static_cast<int>(cells_.size()));
        cells_.push_back(std::move(half));
      }
    }
    if (!cut_any) return false;
    std::sort(refined.begin(), refined.end());
    groups_[group] = refined;
    AddCells(before);
    UpdateOwners();
    return true;
  }

  std::vector<Piece> CutCell(const Piece& cell) const {
    if (cell.mesh.empty()) return {};
    std::vector<Piece> pieces;
    if (cell.Excess() > 1e-3 * cell.volume) pieces = BestCut(cell, context_);
    return pieces.empty() ? Halved(cell, context_) : pieces;
  }

  const CutContext& context_;
  std::vector<Piece>& cells_;
  std::vector<std::vector<Vector3d>> outlines_;  // of each cell: vertices of its hull
  std::vector<std::vector<int>> neighbours_;     // of each cell
  std::vector<CellSet> groups_;
  std::vector<double> cost_;  // of each group
  std::vector<int> owner_;    // group of each cell; -1: none
  std::vector<int> changed_;  // groups, by the last improvement
  std::map<CellSet, Known> known_;
  int budget_ = 0;
  int most_cells_ = 0;
};

}  // namespace

void RegroupCells(const CutContext& context, int evaluations, std::vector<Piece>* cells,
                  std::vector<Piece>* parts) {
  if (parts->size() < 2) return;
  Regrouping regrouping(context, evaluations, cells, *parts);
  regrouping.Run();
  *parts = regrouping.Parts();
}

}  // namespace simwright::geometry
