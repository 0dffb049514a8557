#include "reward/ir/graph.h"

#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "reward/runtime/kernels.h"

namespace simwright::reward {
namespace {

bool Commutes(ScalarOperation operation) {
  using enum ScalarOperation;
  return operation == kAdd || operation == kMultiply || operation == kEqual ||
         operation == kNotEqual || operation == kAnd || operation == kOr;
}

// Returns true if the result is 0 or 1.
bool IsFlag(ScalarOperation operation) {
  using enum ScalarOperation;
  return operation == kLess || operation == kLessEqual || operation == kEqual ||
         operation == kNotEqual || operation == kAnd || operation == kOr || operation == kNot ||
         operation == kIsNan;
}

}  // namespace

std::size_t Graph::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = 0x9E3779B97F4A7C15ull;
  for (const std::int64_t part : {key.first, key.second, key.third}) {
    hash ^= static_cast<std::uint64_t>(part);
    hash *= 0xFF51AFD7ED558CCDull;
    hash ^= hash >> 32;
  }
  return hash;
}

NodeId Graph::Add(const Node& node) {
  const Key key = {(static_cast<std::int64_t>(node.operation) << 32) | node.index,
                   (static_cast<std::int64_t>(node.operands[0]) << 32) ^
                       static_cast<std::uint32_t>(node.operands[1]),
                   (static_cast<std::int64_t>(node.operands[2]) << 32) ^
                       std::bit_cast<std::uint32_t>(node.value)};
  const auto [found, fresh] = known_.try_emplace(key, size());
  if (!fresh) return found->second;
  if (size() >= max_nodes_) {
    Fail(
        "too-large", {},
        "the program computes more than " + std::to_string(max_nodes_) + " numbers an environment");
  }
  nodes_.push_back(node);
  return size() - 1;
}

NodeId Graph::Constant(double value) {
  Node node;
  node.value = static_cast<float>(value);
  return Add(node);
}

NodeId Graph::Input(int index, bool uniform) {
  Node node;
  node.operation = ScalarOperation::kInput;
  node.index = index;
  node.uniform = uniform;
  return Add(node);
}

NodeId Graph::BatchSize() {
  Node node;
  node.operation = ScalarOperation::kBatchSize;
  return Add(node);
}

bool Graph::IsConstant(NodeId id, float* value) const {
  if (nodes_[id].operation != ScalarOperation::kConstant) return false;
  if (value != nullptr) *value = nodes_[id].value;
  return true;
}

// Applies simplifications that change no number except the sign of a zero. Returns -1 if none
// applies.
NodeId Graph::SimplifyBinary(ScalarOperation operation, NodeId a, NodeId b) const {
  using enum ScalarOperation;
  float left = 0.0f, right = 0.0f;
  const bool left_known = IsConstant(a, &left), right_known = IsConstant(b, &right);
  switch (operation) {
    case kAdd:
      if (right_known && right == 0.0f) return a;
      return left_known && left == 0.0f ? b : -1;
    case kSubtract:
      return right_known && right == 0.0f ? a : -1;
    case kMultiply:
      if (right_known && right == 1.0f) return a;
      return left_known && left == 1.0f ? b : -1;
    case kDivide:
    case kPower:
      return right_known && right == 1.0f ? a : -1;
    case kMinimum:
    case kMaximum:
      return a == b ? a : -1;
    case kNotEqual:
      return right_known && right == 0.0f && IsFlag(nodes_[a].operation) ? a : -1;
    case kAnd:
      if (right_known && right != 0.0f && IsFlag(nodes_[a].operation)) return a;
      return left_known && left != 0.0f && IsFlag(nodes_[b].operation) ? b : -1;
    case kOr:
      if (right_known && right == 0.0f && IsFlag(nodes_[a].operation)) return a;
      return left_known && left == 0.0f && IsFlag(nodes_[b].operation) ? b : -1;
    default:
      return -1;
  }
}

NodeId Graph::Simplify(ScalarOperation operation, NodeId a, NodeId b, NodeId c) const {
  using enum ScalarOperation;
  const Node& first = nodes_[a];
  float condition = 0.0f;
  switch (operation) {
    case kSelect:
      if (b == c) return b;
      return IsConstant(a, &condition) ? (condition != 0.0f ? b : c) : -1;
    case kNegate:
      return first.operation == kNegate ? first.operands[0] : -1;
    case kNot:
      return first.operation == kNot && IsFlag(nodes_[first.operands[0]].operation)
                 ? first.operands[0]
                 : -1;
    case kAbsolute:
      return first.operation == kAbsolute || first.operation == kSquareRoot ? a : -1;
    case kTruncate:
    case kFloor:
    case kCeiling:
    case kRound:
      return first.operation >= kFloor && first.operation <= kSign ? a : -1;
    default:
      return OperandCount(operation) == 2 ? SimplifyBinary(operation, a, b) : -1;
  }
}

// Reduces over environments that all have the same number.
NodeId Graph::ReduceUniform(ScalarOperation operation, NodeId a) {
  if (operation != ScalarOperation::kBatchSum) return a;
  return Apply(ScalarOperation::kMultiply, a, BatchSize());
}

NodeId Graph::Apply(ScalarOperation operation, NodeId a, NodeId b, NodeId c) {
  using enum ScalarOperation;
  if (CrossesEnvironments(operation) && nodes_[a].uniform) return ReduceUniform(operation, a);
  const int count = OperandCount(operation);
  Node node;
  node.operation = operation;
  const NodeId operands[3] = {a, b, c};
  float values[3] = {};
  bool known = !CrossesEnvironments(operation);
  for (int i = 0; i < count; ++i) {
    node.operands[i] = operands[i];
    node.uniform = node.uniform && nodes_[operands[i]].uniform;
    known = IsConstant(operands[i], &values[i]) && known;
  }
  if (known) return Constant(EvaluateScalar(operation, values[0], values[1], values[2]));
  if (CrossesEnvironments(operation)) {
    node.uniform = operation != kBatchFlip;
    return Add(node);
  }
  const NodeId simple = Simplify(operation, a, b, c);
  if (simple >= 0) return simple;
  float exponent = 0.0f;
  if (operation == kPower && IsConstant(b, &exponent)) {
    if (exponent == 2.0f) return Apply(kMultiply, a, a);
    if (exponent == 3.0f) return Apply(kMultiply, Apply(kMultiply, a, a), a);
    if (exponent == 0.5f) return Apply(kSquareRoot, a);
    if (exponent == -1.0f) return Apply(kDivide, Constant(1.0), a);
    if (exponent == -2.0f) return Apply(kDivide, Constant(1.0), Apply(kMultiply, a, a));
    if (exponent == 0.0f) return Constant(1.0);
  }
  if (Commutes(operation) && node.operands[0] > node.operands[1]) {
    std::swap(node.operands[0], node.operands[1]);
  }
  return Add(node);
}

NodeId Graph::Pick(NodeId a, int environment) {
  if (nodes_[a].uniform) return a;
  Node node;
  node.operation = ScalarOperation::kBatchPick;
  node.operands[0] = a;
  node.index = environment;
  return Add(node);
}

}  // namespace simwright::reward
