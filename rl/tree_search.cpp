#include "rl/tree_search.h"

#include <algorithm>
#include <limits>

#include "core/random.h"

namespace simwright::rl {
namespace {

constexpr int kRounds = 600;        // each extends one tree by at least one node
constexpr double kStep = 0.35;      // rad or m of any joint per extension
constexpr double kBaseRange = 0.4;  // m about both ends in which a base is sampled
constexpr double kMetre = 3.0;      // rad that a metre counts as
constexpr size_t kLongest = 12;     // waypoints

struct Node {
  robot::Posture posture;
  int parent = -1;
};
using Tree = std::vector<Node>;

// Returns the squared distance in rad^2, with metres of a base weighted by kMetre.
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

enum class Extension { kTrapped, kAdvanced, kReached };

// Extends the tree by one step from its nearest configuration towards `to`.
Extension Extend(const robot::Arm& arm, const ArmClearance& clearance, const robot::Posture& to,
                 Tree* tree) {
  const int nearest = Nearest(arm, *tree, to);
  const robot::Posture from = (*tree)[static_cast<size_t>(nearest)].posture;
  const robot::Posture way = to - from;
  const double length = way.lpNorm<Eigen::Infinity>();
  const bool reached = length <= kStep;
  const robot::Posture next = reached ? to : robot::Posture(from + kStep / length * way);
  if (!clearance.IsWayClear(from, next)) return Extension::kTrapped;
  tree->push_back({next, nearest});
  return reached ? Extension::kReached : Extension::kAdvanced;
}

robot::Posture SampleConfiguration(const robot::Arm& arm, const robot::Posture& from,
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

// Returns the path from the root to the newest node.
Detour PathFromRoot(const Tree& tree) {
  Detour branch;
  for (int at = static_cast<int>(tree.size()) - 1; at >= 0;
       at = tree[static_cast<size_t>(at)].parent) {
    branch.push_back(tree[static_cast<size_t>(at)].posture);
  }
  std::reverse(branch.begin(), branch.end());
  return branch;
}

// Returns the waypoints between the ends of `way` that are needed after shortcutting.
Detour Shortcut(const ArmClearance& clearance, const Detour& way) {
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
    Tree& extended = trees[round % 2];
    Tree& other = trees[1 - round % 2];
    if (Extend(arm, clearance, SampleConfiguration(arm, from, to, rng), &extended) ==
        Extension::kTrapped) {
      continue;
    }
    const robot::Posture target = extended.back().posture;
    Extension extension = Extension::kAdvanced;
    while (extension == Extension::kAdvanced) extension = Extend(arm, clearance, target, &other);
    if (extension != Extension::kReached) continue;
    Detour way = PathFromRoot(trees[0]);
    const Detour goal_path = PathFromRoot(trees[1]);
    way.insert(way.end(), goal_path.rbegin() + 1, goal_path.rend());
    Detour detour = Shortcut(clearance, way);
    if (detour.size() > kLongest) return std::nullopt;
    return detour;
  }
  return std::nullopt;
}

}  // namespace simwright::rl
