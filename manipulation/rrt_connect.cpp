#include "manipulation/rrt_connect.h"

#include <algorithm>
#include <limits>

#include "core/random.h"

namespace simwright::manipulation {
namespace {

constexpr double kStep = 0.35;      // rad or m of any joint per extension
constexpr double kBaseRange = 0.4;  // m about both ends in which a base is sampled
constexpr double kMetre = 3.0;      // rad that a metre counts as
constexpr size_t kLongest = 12;     // waypoints

struct Node {
  robot::JointVector configuration;
  int parent = -1;
};
using Tree = std::vector<Node>;

// Returns the squared distance in rad^2, with metres of a base weighted by kMetre.
double SquaredDistance(const robot::Arm& arm, const robot::JointVector& a,
                       const robot::JointVector& b) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    const double difference =
        (a[j] - b[j]) * (arm.joints[static_cast<size_t>(j)].prismatic ? kMetre : 1.0);
    sum += difference * difference;
  }
  return sum;
}

int Nearest(const robot::Arm& arm, const Tree& tree, const robot::JointVector& to) {
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < tree.size(); ++i) {
    const double distance = SquaredDistance(arm, tree[i].configuration, to);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

enum class Extension { kTrapped, kAdvanced, kReached };

// Extends the tree by one step from its nearest configuration towards `to`.
Extension RrtConnectExtend(const robot::Arm& arm, const PathChecker& clearance,
                           const robot::JointVector& to, Tree* tree) {
  const int nearest = Nearest(arm, *tree, to);
  const robot::JointVector from = (*tree)[static_cast<size_t>(nearest)].configuration;
  const robot::JointVector displacement = to - from;
  const double length = displacement.lpNorm<Eigen::Infinity>();
  const bool reached = length <= kStep;
  const robot::JointVector next =
      reached ? to : robot::JointVector(from + kStep / length * displacement);
  if (!clearance.IsPathCollisionFree(from, next)) return Extension::kTrapped;
  tree->push_back({next, nearest});
  return reached ? Extension::kReached : Extension::kAdvanced;
}

robot::JointVector SampleConfiguration(const robot::Arm& arm, const robot::JointVector& from,
                                       const robot::JointVector& to, core::Rng& rng) {
  robot::JointVector configuration = from;
  for (Eigen::Index j = 0; j < configuration.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    double low = joint.lower, high = joint.upper;
    if (joint.prismatic) {
      low = std::max(low, std::min(from[j], to[j]) - kBaseRange);
      high = std::min(high, std::max(from[j], to[j]) + kBaseRange);
    }
    configuration[j] = core::Uniform(rng, low, high);
  }
  return configuration;
}

// Returns the path from the root to the newest node.
JointPath PathFromRoot(const Tree& tree) {
  JointPath branch;
  for (int at = static_cast<int>(tree.size()) - 1; at >= 0;
       at = tree[static_cast<size_t>(at)].parent) {
    branch.push_back(tree[static_cast<size_t>(at)].configuration);
  }
  std::reverse(branch.begin(), branch.end());
  return branch;
}

// Returns the waypoints between the ends of `path` that are needed after shortcutting.
JointPath Shortcut(const PathChecker& clearance, const JointPath& path) {
  JointPath kept;
  size_t at = 0;
  while (at + 1 < path.size()) {
    size_t next = path.size() - 1;
    while (next > at + 1 && !clearance.IsPathCollisionFree(path[at], path[next])) --next;
    if (next + 1 < path.size()) kept.push_back(path[next]);
    at = next;
  }
  return kept;
}

}  // namespace

std::optional<JointPath> PlanRrtConnect(const robot::Arm& arm, const PathChecker& clearance,
                                        const robot::JointVector& from,
                                        const robot::JointVector& to, int rounds) {
  if (!clearance.IsConfigurationFree(to)) return std::nullopt;
  core::Rng rng = core::StreamRng(0, 0);
  Tree trees[2] = {{{from, -1}}, {{to, -1}}};
  for (int round = 0; round < rounds; ++round) {
    Tree& extended = trees[round % 2];
    Tree& other = trees[1 - round % 2];
    if (RrtConnectExtend(arm, clearance, SampleConfiguration(arm, from, to, rng), &extended) ==
        Extension::kTrapped) {
      continue;
    }
    const robot::JointVector target = extended.back().configuration;
    Extension extension = Extension::kAdvanced;
    while (extension == Extension::kAdvanced)
      extension = RrtConnectExtend(arm, clearance, target, &other);
    if (extension != Extension::kReached) continue;
    JointPath path = PathFromRoot(trees[0]);
    const JointPath goal_path = PathFromRoot(trees[1]);
    path.insert(path.end(), goal_path.rbegin() + 1, goal_path.rend());
    JointPath joint_path = Shortcut(clearance, path);
    if (joint_path.size() > kLongest) return std::nullopt;
    return joint_path;
  }
  return std::nullopt;
}

}  // namespace simwright::manipulation
