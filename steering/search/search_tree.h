#pragma once

#include <vector>

namespace simwright::steering {

// A node of a search tree. Numbers of nodes are in the order in which they were added.
struct TreeNode {
  int parent = -1;  // -1: the root
  std::vector<int> children = {};
  double reward = 0.0;    // its own
  bool terminal = false;  // nothing is left to do: it is never expanded
  int visits = 0;
  double total = 0.0;  // the sum of the rewards backpropagated through it
};

// Returns the upper confidence bound of a child: mean + c sqrt(2 ln(parent_visits) / visits)
// (Kocsis and Szepesvari 2006, in the form of Pfaff et al.); HUGE_VAL for a child without visits.
double UctValue(double mean, double exploration, int parent_visits, int visits);

// A tree that is searched by UCT. Rewards may have any scale: before they are compared, means are
// mapped to [0, 1] by the smallest and the largest reward of a node so far, so that the exploration
// constant means the same for counts of objects and for agreements between 0 and 1.
class SearchTree {
 public:
  // `scaled`: false keeps the rewards as they are, which makes the search of a count nearly greedy.
  explicit SearchTree(double exploration, bool scaled = true)
      : exploration_(exploration), scaled_(scaled) {}

  // Adds a node below `parent`, -1 for the root, which comes first, and returns its number. It has
  // no visits yet.
  int Add(int parent, double reward, bool terminal);
  // Counts a visit with this reward for the node and all above it.
  void Backpropagate(int node, double reward);

  // Returns the leaf that is reached from the root by the child with the largest UctValue, the
  // first of several; -1 if all leaves are terminal.
  int Select() const;
  // Returns at most `count` different leaves to expand together. After each one its path has
  // another visit with the smallest reward (virtual loss), which leads the next one elsewhere.
  std::vector<int> SelectSeveral(int count) const;

  // Corrects the reward of a node that was not backpropagated yet.
  void SetReward(int node, double reward, bool terminal);

  const std::vector<TreeNode>& nodes() const { return nodes_; }
  // Returns the nodes from the root to this one.
  std::vector<int> PathTo(int node) const;
  // Restores a tree that was saved. Throws core::Error if its links are not those of a tree.
  void Restore(std::vector<TreeNode> nodes);

 private:
  int Descend(const std::vector<int>& pending, const std::vector<char>& closed) const;
  // Returns, for each node, true if no leaf below it can be expanded.
  std::vector<char> Closed() const;
  double Scaled(double reward) const;
  void Widen(double reward);

  double exploration_;
  bool scaled_;
  std::vector<TreeNode> nodes_;
  double low_ = 0.0, high_ = 0.0;  // of the rewards of all nodes
};

}  // namespace simwright::steering
