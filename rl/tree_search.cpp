#include "rl/tree_search.h"

#include <algorithm>
#include <limits>

#include "core/random.h"

namespace simwright::rl {
namespace {

constexpr int kRounds = 600;        // each grows either tree by a posture at least
constexpr double kStep = 0.35;      // rad or m of any joint, from a posture to the next
constexpr double kBaseRange = 0.4;  // m about both ends that a base is moved by
constexpr double kMetre = 3.0;      // rad that a metre counts as
constexpr size_t kLongest = 12;     // postures

struct Node {
  robot::Posture posture;
  int parent = -1;
};
using Tree = std::vector<Node>;

// rad^2, metres of a base counted as kMetre.
double SquaredDistance(const robot::Arm& arm, const robot::Posture& a, const robot::Posture& b) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    const double way =
        (a[j] - b[j]) * (arm.joints[static_cast<size_t>(j)].prismatic ? kMetre : 1.0);
    sum += way * way;
  }
  return sum;
}

int Nearest(const robot::Arm& arm, const Tree& tree, const robot::Posture& to) {
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < tree.size(); ++i) {
    const double distance = SquaredDistance(arm, tree[i].posture, to);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

enum class Growth { kStuck, kNearer, kThere };

// By one step from its nearest posture towards `to`.
Growth Grow(const robot::Arm& arm, const ArmClearance& clearance, const robot::Posture& to,
            Tree* tree) {
  const int nearest = Nearest(arm, *tree, to);
  const robot::Posture from = (*tree)[static_cast<size_t>(nearest)].posture;
  const robot::Posture way = to - from;
  const double length = way.lpNorm<Eigen::Infinity>();
  const bool there = length <= kStep;
  const robot::Posture next = there ? to : robot::Posture(from + kStep / length * way);
  if (!clearance.IsWayClear(from, next)) return Growth::kStuck;
  tree->push_back({next, nearest});
  return there ? Growth::kThere : Growth::kNearer;
}

robot::Posture Somewhere(const robot::Arm& arm, const robot::Posture& from,
                         const robot::Posture& to, core::Rng& rng) {
  robot::Posture posture = from;
  for (Eigen::Index j = 0; j < posture.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    double low = joint.lower, high = joint.upper;
    if (joint.prismatic) {
      low = std::max(low, std::min(from[j], to[j]) - kBaseRange);
      high = std::min(high, std::max(from[j], to[j]) + kBaseRange);
    }
    posture[j] = core::Uniform(rng, low, high);
  }
  return posture;
}

// From the root to the newest posture.
Detour Branch(const Tree& tree) {
  Detour branch;
  for (int at = static_cast<int>(tree.size()) - 1; at >= 0;
       at = tree[static_cast<size_t>(at)].parent) {
    branch.push_back(tree[static_cast<size_t>(at)].posture);
  }
  std::reverse(branch.begin(), branch.end());
  return branch;
}

// The postures between the ends of `way` that are needed.
Detour CutShort(const ArmClearance& clearance, const Detour& way) {
  Detour kept;
  size_t at = 0;
  while (at + 1 < way.size()) {
    size_t next = way.size() - 1;
    while (next > at + 1 && !clearance.IsWayClear(way[at], way[next])) --next;
    if (next + 1 < way.size()) kept.push_back(way[next]);
    at = next;
  }
  return kept;
}

}  // namespace

std::optional<Detour> SearchDetour(const robot::Arm& arm, const ArmClearance& clearance,
                                   const robot::Posture& from, const robot::Posture& to) {
  if (!clearance.IsClear(to)) return std::nullopt;
  core::Rng rng = core::StreamRng(0, 0);
  Tree trees[2] = {{{from, -1}}, {{to, -1}}};
  for (int round = 0; round < kRounds; ++round) {
    Tree& grown = trees[round % 2];
    Tree& other = trees[1 - round % 2];
    if (Grow(arm, clearance, Somewhere(arm, from, to, rng), &grown) == Growth::kStuck) continue;
    const robot::Posture target = grown.back().posture;
    Growth growth = Growth::kNearer;
    while (growth == Growth::kNearer) growth = Grow(arm, clearance, target, &other);
    if (growth != Growth::kThere) continue;
    Detour way = Branch(trees[0]);
    const Detour back = Branch(trees[1]);
    way.insert(way.end(), back.rbegin() + 1, back.rend());
    Detour detour = CutShort(clearance, way);
    if (detour.size() > kLongest) return std::nullopt;
    return detour;
  }
  return std::nullopt;
}

}  // namespace simwright::rl
