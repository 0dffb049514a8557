#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "reward/fault.h"
#include "reward/ir/scalar_operation.h"

namespace simwright::reward {

using NodeId = std::int32_t;

// One number per environment: a constant, an input, or the result of an operation. Flags are 0 or
// 1, integers are whole floats (exact to 2^24).
struct Node {
  ScalarOperation operation = ScalarOperation::kConstant;
  NodeId operands[3] = {-1, -1, -1};
  float value = 0.0f;      // value of a constant
  std::int32_t index = 0;  // number of an input; environment of a pick
  bool uniform = true;     // equal in all environments
};

// A program as a directed acyclic graph: operands precede their users. Equal nodes are shared and
// constants are folded.
class Graph {
 public:
  explicit Graph(int max_nodes) : max_nodes_(max_nodes) {}

  NodeId Constant(double value);
  NodeId Input(int index, bool uniform);
  NodeId BatchSize();
  NodeId Apply(ScalarOperation operation, NodeId a, NodeId b = -1, NodeId c = -1);
  // Returns environment `environment`'s value as a number for all; a negative index counts from the
  // last.
  NodeId Pick(NodeId a, int environment);

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  int size() const { return static_cast<int>(nodes_.size()); }
  bool IsConstant(NodeId id, float* value = nullptr) const;

 private:
  struct Key {
    std::int64_t first, second, third;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  NodeId Add(const Node& node);
  NodeId Simplify(ScalarOperation operation, NodeId a, NodeId b, NodeId c) const;
  NodeId SimplifyBinary(ScalarOperation operation, NodeId a, NodeId b) const;
  NodeId ReduceUniform(ScalarOperation operation, NodeId a);

  int max_nodes_;
  std::vector<Node> nodes_;
  std::unordered_map<Key, NodeId, KeyHash> known_;
};

}  // namespace simwright::reward
