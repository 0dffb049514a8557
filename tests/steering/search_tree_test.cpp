// The search tree: the formula of UCT, the choice between exploration and exploitation, and several
// leaves at a time.
#include "steering/search/search_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/error.h"
#include "core/random.h"

namespace simwright::steering {
namespace {

TEST(SearchTree, UctIsTheClosedForm) {
  EXPECT_DOUBLE_EQ(UctValue(0.5, 1.4, 10, 3), 0.5 + 1.4 * std::sqrt(2.0 * std::log(10.0) / 3.0));
  EXPECT_DOUBLE_EQ(UctValue(0.25, 0.0, 10, 3), 0.25);
  EXPECT_EQ(UctValue(0.0, 1.4, 10, 0), HUGE_VAL);
  EXPECT_DOUBLE_EQ(UctValue(0.25, 1.4, 1, 1), 0.25);  // ln 1 = 0
}

// Expands a leaf `count` times: two children with the rewards of `reward_of`, both backpropagated.
// A toy scene is a path of left (0) and right (1).
void Expand(SearchTree* tree, int count, int depth,
            const std::function<double(const std::vector<int>&)>& reward_of) {
  for (int i = 0; i < count; ++i) {
    const int leaf = tree->Select();
    if (leaf < 0) return;
    std::vector<int> path;
    for (int at = leaf; tree->nodes()[static_cast<size_t>(at)].parent >= 0;) {
      const int parent = tree->nodes()[static_cast<size_t>(at)].parent;
      path.push_back(tree->nodes()[static_cast<size_t>(parent)].children[1] == at);
      at = parent;
    }
    std::reverse(path.begin(), path.end());
    for (const int side : {0, 1}) {
      path.push_back(side);
      const double reward = reward_of(path);
      tree->Backpropagate(tree->Add(leaf, reward, static_cast<int>(path.size()) == depth), reward);
      path.pop_back();
    }
  }
}

double Largest(const SearchTree& tree) {
  double largest = 0.0;
  for (const TreeNode& node : tree.nodes()) largest = std::max(largest, node.reward);
  return largest;
}

// The left half pays 20, 21, ... 24 with the depth and ends there; the right one starts with 18 and
// ends at 34. Counts of objects have such values.
double Trap(const std::vector<int>& path) {
  if (path[0] == 0) return 20.0 + std::min<double>(4.0, static_cast<double>(path.size()) - 1.0);
  double reward = 18.0;
  for (size_t i = 1; i < path.size(); ++i) reward += path[i] == 1 ? 2.7 : -1.0;
  return reward;
}

TEST(SearchTree, ScaledRewardsLeaveATrapThatRawOnesDoNot) {
  constexpr int kDepth = 7, kExpansions = 40;  // of 127 inner nodes
  const auto search = [&](double exploration, bool scaled) {
    SearchTree tree(exploration, scaled);
    tree.Backpropagate(tree.Add(-1, 19.0, false), 19.0);
    Expand(&tree, kExpansions, kDepth, Trap);
    return Largest(tree);
  };
  EXPECT_NEAR(search(1.0, true), 18.0 + 6 * 2.7, 1e-9);  // the best of all 254 scenes
  EXPECT_DOUBLE_EQ(search(0.0, true), 24.0);             // greedy
  EXPECT_DOUBLE_EQ(search(1.4, false), 24.0);            // nearly greedy
}

TEST(SearchTree, ScalingMakesTheUnitOfRewardsIrrelevant) {
  const auto shape = [](double factor, double offset) {
    SearchTree tree(0.7);
    const auto reward = [&](const std::vector<int>& path) { return factor * Trap(path) + offset; };
    tree.Backpropagate(tree.Add(-1, factor * 19.0 + offset, false), factor * 19.0 + offset);
    Expand(&tree, 60, 30, reward);
    std::vector<int> parents;
    for (const TreeNode& node : tree.nodes()) parents.push_back(node.parent);
    return parents;
  };
  EXPECT_EQ(shape(1.0, 0.0), shape(1024.0, -512.0));
}

// A bandit: three arms with rewards of 0 or 1; each visit to an arm extends a chain below it.
TEST(SearchTree, VisitCountsFollowUct) {
  const double means[] = {0.3, 0.5, 0.8};
  constexpr int kVisits = 3000;
  constexpr double kExploration = 0.5;
  core::Rng rng(7);
  SearchTree tree(kExploration);
  tree.Backpropagate(tree.Add(-1, 0.0, false), 0.0);
  std::vector<int> visits(3, 0), tips;
  std::vector<double> totals(3, 0.0);
  for (int arm = 0; arm < 3; ++arm) {
    const double reward = arm == 0 ? 0.0 : 1.0;  // both ends of the scale are seen
    tips.push_back(tree.Add(0, reward, false));
    tree.Backpropagate(tips.back(), reward);
    ++visits[static_cast<size_t>(arm)];
    totals[static_cast<size_t>(arm)] += reward;
  }
  for (int i = 0; i < kVisits; ++i) {
    // The reference: UCB1 by its formula.
    size_t best = 0;
    double largest = -1.0;
    for (size_t arm = 0; arm < 3; ++arm) {
      const double value = totals[arm] / visits[arm] +
                           kExploration * std::sqrt(2.0 * std::log(4.0 + i) / visits[arm]);
      if (value > largest) best = arm, largest = value;
    }
    const int leaf = tree.Select();
    ASSERT_EQ(leaf, tips[best]) << "visit " << i;
    const double reward = core::Uniform(rng) < means[best] ? 1.0 : 0.0;
    tips[best] = tree.Add(leaf, reward, false);
    tree.Backpropagate(tips[best], reward);
    ++visits[best];
    totals[best] += reward;
  }
  EXPECT_GT(visits[2], 0.9 * kVisits);
  EXPECT_GT(visits[0], 5);  // bad arms are still tried, about 2 c^2 ln(n) / gap^2 times (Auer 2002)
  EXPECT_LT(visits[0], 2 * 2 * 0.25 * std::log(kVisits) / (0.5 * 0.5));
}

TEST(SearchTree, SeveralLeavesDifferAndClosedOnesAreLeftOut) {
  SearchTree tree(0.1);
  tree.Backpropagate(tree.Add(-1, 1.0, false), 1.0);
  for (const double reward : {3.0, 2.9, 1.0}) {
    tree.Backpropagate(tree.Add(0, reward, false), reward);
  }
  EXPECT_EQ(tree.Select(), 1);
  const std::vector<int> leaves = tree.SelectSeveral(2);
  EXPECT_EQ(leaves, (std::vector<int>{1, 2}));  // virtual loss leads the second one elsewhere
  for (const int child : {1, 2}) {
    tree.Backpropagate(tree.Add(child, 5.0, true), 5.0);
  }
  EXPECT_EQ(tree.Select(), 3);
  EXPECT_EQ(tree.SelectSeveral(3), std::vector<int>{3});
  tree.Backpropagate(tree.Add(3, 5.0, true), 5.0);
  EXPECT_EQ(tree.Select(), -1);
  EXPECT_TRUE(tree.SelectSeveral(3).empty());
}

TEST(SearchTree, RestoresItsNodesAndRefusesOthers) {
  SearchTree tree(0.3);
  tree.Backpropagate(tree.Add(-1, 19.0, false), 19.0);
  Expand(&tree, 10, 5, Trap);
  SearchTree again(0.3);
  again.Restore(tree.nodes());
  Expand(&tree, 5, 5, Trap);
  Expand(&again, 5, 5, Trap);
  ASSERT_EQ(tree.nodes().size(), again.nodes().size());
  for (size_t i = 0; i < tree.nodes().size(); ++i) {
    EXPECT_EQ(tree.nodes()[i].visits, again.nodes()[i].visits);
    EXPECT_EQ(tree.nodes()[i].total, again.nodes()[i].total);
  }
  std::vector<TreeNode> looped(2);
  looped[1].parent = 1;
  EXPECT_THROW(again.Restore(looped), core::Error);
  looped[1].parent = 0;
  looped[1].total = NAN;
  EXPECT_THROW(again.Restore(looped), core::Error);
}

}  // namespace
}  // namespace simwright::steering
