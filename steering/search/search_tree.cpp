#include "steering/search/search_tree.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::steering {

double UctValue(double mean, double exploration, int parent_visits, int visits) {
  if (visits == 0) return HUGE_VAL;
  return mean + exploration * std::sqrt(2.0 * std::log(std::max(1, parent_visits)) / visits);
}

int SearchTree::Add(int parent, double reward, bool terminal) {
  const auto number = static_cast<int>(nodes_.size());
  TreeNode node;
  node.parent = parent;
  node.reward = reward;
  node.terminal = terminal;
  nodes_.push_back(node);
  if (parent >= 0) nodes_[static_cast<size_t>(parent)].children.push_back(number);
  Widen(reward);
  return number;
}

void SearchTree::Widen(double reward) {
  const bool first = nodes_.size() == 1;
  low_ = first ? reward : std::min(low_, reward);
  high_ = first ? reward : std::max(high_, reward);
}

void SearchTree::SetReward(int node, double reward, bool terminal) {
  nodes_[static_cast<size_t>(node)].reward = reward;
  nodes_[static_cast<size_t>(node)].terminal = terminal;
  low_ = high_ = nodes_.front().reward;
  for (const TreeNode& one : nodes_) {
    low_ = std::min(low_, one.reward);
    high_ = std::max(high_, one.reward);
  }
}

void SearchTree::Backpropagate(int node, double reward) {
  for (int at = node; at >= 0; at = nodes_[static_cast<size_t>(at)].parent) {
    nodes_[static_cast<size_t>(at)].visits += 1;
    nodes_[static_cast<size_t>(at)].total += reward;
  }
}

double SearchTree::Scaled(double reward) const {
  if (!scaled_) return reward;
  return high_ > low_ ? (reward - low_) / (high_ - low_) : 0.5;
}

std::vector<char> SearchTree::Closed() const {
  std::vector<char> closed(nodes_.size(), 0);
  for (size_t i = nodes_.size(); i-- > 0;) {  // children after their parents
    const TreeNode& node = nodes_[i];
    closed[i] = node.children.empty()
                    ? node.terminal
                    : std::all_of(node.children.begin(), node.children.end(), [&](int child) {
                        return closed[static_cast<size_t>(child)] != 0;
                      });
  }
  return closed;
}

int SearchTree::Descend(const std::vector<int>& pending, const std::vector<char>& closed) const {
  if (nodes_.empty() || closed.front()) return -1;
  int at = 0;
  while (!nodes_[static_cast<size_t>(at)].children.empty()) {
    const TreeNode& node = nodes_[static_cast<size_t>(at)];
    const int parent_visits = node.visits + pending[static_cast<size_t>(at)];
    int best = -1;
    double largest = -HUGE_VAL;
    for (const int child : node.children) {
      const auto index = static_cast<size_t>(child);
      if (closed[index]) continue;
      const int visits = nodes_[index].visits + pending[index];
      const double total = nodes_[index].total + pending[index] * low_;
      const double mean = visits > 0 ? Scaled(total / visits) : 0.0;
      const double value = UctValue(mean, exploration_, parent_visits, visits);
      if (best >= 0 && value <= largest) continue;
      best = child;
      largest = value;
    }
    at = best;
  }
  return at;
}

int SearchTree::Select() const {
  return Descend(std::vector<int>(nodes_.size(), 0), Closed());
}

std::vector<int> SearchTree::SelectSeveral(int count) const {
  std::vector<int> leaves, pending(nodes_.size(), 0);
  const std::vector<char> closed = Closed();
  for (int tries = 0; static_cast<int>(leaves.size()) < count && tries < 4 * count; ++tries) {
    const int leaf = Descend(pending, closed);
    if (leaf < 0) break;
    for (int at = leaf; at >= 0; at = nodes_[static_cast<size_t>(at)].parent) {
      ++pending[static_cast<size_t>(at)];
    }
    if (std::count(leaves.begin(), leaves.end(), leaf) == 0) leaves.push_back(leaf);
  }
  return leaves;
}

std::vector<int> SearchTree::PathTo(int node) const {
  std::vector<int> path;
  for (int at = node; at >= 0; at = nodes_[static_cast<size_t>(at)].parent) path.push_back(at);
  std::reverse(path.begin(), path.end());
  return path;
}

void SearchTree::Restore(std::vector<TreeNode> nodes) {
  nodes_.clear();
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int parent = nodes[i].parent;
    const bool fits = parent >= -1 && parent < static_cast<int>(i);
    if (!fits || nodes[i].visits < 0 || !std::isfinite(nodes[i].reward) ||
        !std::isfinite(nodes[i].total)) {
      throw core::Error("the saved search is not a tree", "node " + std::to_string(i));
    }
    const int number = Add(parent, nodes[i].reward, nodes[i].terminal);
    nodes_[static_cast<size_t>(number)].visits = nodes[i].visits;
    nodes_[static_cast<size_t>(number)].total = nodes[i].total;
  }
}

}  // namespace simwright::steering
