// Branches that only some environments take: both are executed, and differing values are selected
// per environment.
#include <algorithm>

#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

// Returns true if two values are certainly identical; gives up and returns false on large tuples.
bool SameValue(const Value& a, const Value& b, int* budget) {
  if (--*budget < 0) return false;
  if (a.kind != b.kind || a.integer != b.integer || a.number != b.number || a.text != b.text ||
      a.object != b.object || a.function != b.function || a.library != b.library ||
      a.closure != b.closure) {
    return false;
  }
  if (a.Is(ValueKind::kTensor)) {
    return a.tensor == b.tensor ||
           (a.tensor->storage == b.tensor->storage && a.tensor->shape == b.tensor->shape &&
            a.tensor->lanes == b.tensor->lanes && a.tensor->type == b.tensor->type);
  }
  if (a.items == b.items) return true;
  if (a.items == nullptr || b.items == nullptr || a.items->size() != b.items->size()) return false;
  return std::equal(a.items->begin(), a.items->end(), b.items->begin(),
                    [&](const Value& x, const Value& y) { return SameValue(x, y, budget); });
}

bool SameValue(const Value& a, const Value& b) {
  int budget = 1000;
  return SameValue(a, b, &budget);
}

Value Differs(const std::string& how) {
  return PlainValue(ValueKind::kUndefined, how);
}

std::vector<NodeId> NodesIn(const Tensor& tensor, const std::vector<Object>& heap) {
  std::vector<NodeId> nodes;
  for (const int lane : tensor.lanes) nodes.push_back((*heap[tensor.storage].nodes)[lane]);
  return nodes;
}

}  // namespace

int Elaborator::Truth(const Value& value, Tensor* flag, Position position) {
  switch (value.kind) {
    case ValueKind::kNone:
      return 0;
    case ValueKind::kBool:
    case ValueKind::kInteger:
    case ValueKind::kFloat:
      return value.Number() != 0.0 ? 1 : 0;
    case ValueKind::kString:
      return value.text.empty() ? 0 : 1;
    case ValueKind::kTuple:
      return value.items->empty() ? 0 : 1;
    case ValueKind::kList:
    case ValueKind::kDict:
      return heap_[value.object].items->empty() ? 0 : 1;
    case ValueKind::kTensor:
      break;
    case ValueKind::kBatchSize:
      return 1;
    default:
      math_.FromValue(value, position);  // throws with the appropriate message
  }
  if (value.tensor->lanes.size() != 1 || HasSelectedDimension(value.tensor->shape)) {
    Fail("condition", position,
         "a condition wants one flag an environment, this is " + Describe(value) +
             "; reduce it with .all(dim=-1) or .any(dim=-1)");
  }
  *flag = math_.Cast(*value.tensor, DataType::kBool, position);
  float known = 0.0f;
  if (graph_.IsConstant(math_.At(*flag, 0), &known)) return known != 0.0f ? 1 : 0;
  return -1;
}

Elaborator::Flow Elaborator::ExecuteIf(const Statement& statement, std::size_t branch) {
  if (branch >= statement.targets.size()) {
    return branch < statement.blocks.size() ? Execute(statement.blocks[branch]) : Flow::kNext;
  }
  const Expression& condition = *statement.targets[branch];
  Tensor flag;
  const int truth = Truth(Evaluate(condition), &flag, condition.position);
  if (truth == 1) return Execute(statement.blocks[branch]);
  if (truth == 0) return ExecuteIf(statement, branch + 1);
  return ExecuteBoth(statement, branch, flag);
}

Elaborator::BranchEnd Elaborator::RunBranch(const Statement& statement, std::size_t branch,
                                            bool otherwise) {
  BranchEnd end;
  end.frame = *frame_;
  end.frame.early.clear();
  Frame* const outer = frame_;
  frame_ = &end.frame;
  try {
    end.flow = otherwise ? ExecuteIf(statement, branch + 1) : Execute(statement.blocks[branch]);
    if (end.flow == Flow::kReturn) {
      end.frame.result = DeepCopy(Finish(&end.frame, end.flow, statement.position));
    }
  } catch (const Fault&) {
    frame_ = outer;
    throw;
  }
  frame_ = outer;
  end.heap = heap_.Copy();
  if (end.flow == Flow::kBreak || end.flow == Flow::kContinue) {
    Fail("condition", statement.targets[branch]->position,
         "whether to leave the loop differs between environments; use torch.where on the values "
         "instead");
  }
  return end;
}

Elaborator::Flow Elaborator::ExecuteBoth(const Statement& statement, std::size_t branch,
                                         const Tensor& flag) {
  const Position position = statement.targets[branch]->position;
  const RecursionGuard deeper(this, position);
  const std::vector<Object> before = heap_.Copy();
  steps_ += static_cast<int>(before.size() / 8);
  const int count = static_cast<int>(before.size());
  const BranchEnd yes = RunBranch(statement, branch, false);
  for (int object = 0; object < count; ++object) heap_.Set(object, before[object]);
  const BranchEnd no = RunBranch(statement, branch, true);
  const bool yes_ends = yes.flow == Flow::kReturn, no_ends = no.flow == Flow::kReturn;
  if (yes_ends && no_ends) {
    frame_->result = Choose(flag, yes.frame.result, no.frame.result, returned_at_);
    return Flow::kReturn;
  }
  const auto keep = [&](const BranchEnd& end, bool negate) {
    if (end.flow == Flow::kReturn) {
      frame_->early.push_back(
          {negate ? Both(Tensor{}, flag, true, position) : flag, end.frame.result});
      return;
    }
    for (const EarlyReturn& early : end.frame.early) {
      frame_->early.push_back({Both(early.flag, flag, negate, position), DeepCopy(early.value)});
    }
  };
  keep(yes, false);
  keep(no, true);
  if (yes_ends || no_ends) {  // environments that continue took the other branch
    const BranchEnd& on = yes_ends ? no : yes;
    for (int object = 0; object < count; ++object) heap_.Set(object, on.heap[object]);
    frame_->names = on.frame.names;
    return Flow::kNext;
  }
  JoinNames(flag, yes, no, position);
  JoinObjects(flag, yes, no, count, position);
  return Flow::kNext;
}

// Returns a and b, or a and not b; an empty a counts as true.
Tensor Elaborator::Both(const Tensor& a, const Tensor& b, bool negate_b, Position position) {
  NodeId node = math_.At(b, 0);
  if (negate_b) node = graph_.Apply(ScalarOperation::kNot, node);
  if (!a.lanes.empty()) node = graph_.Apply(ScalarOperation::kAnd, math_.At(a, 0), node);
  return math_.Make(DataType::kBool, b.shape, {node}, position);
}

void Elaborator::JoinNames(const Tensor& flag, const BranchEnd& yes, const BranchEnd& no,
                           Position position) {
  std::map<std::string, Value> names = no.frame.names;
  for (const auto& [name, value] : yes.frame.names) names.emplace(name, value);
  for (auto& [name, value] : names) {
    const auto in_yes = yes.frame.names.find(name), in_no = no.frame.names.find(name);
    if (in_yes == yes.frame.names.end() || in_no == no.frame.names.end()) {
      value =
          Differs("'" + name + "' is set only where the condition in line " +
                  std::to_string(position.line) + " goes one way; set it before the 'if' as well");
    } else if (!SameValue(in_yes->second, in_no->second)) {
      value = Join(flag, {in_yes->second, yes.heap}, {in_no->second, no.heap}, position);
    }
  }
  frame_->names = std::move(names);
}

void Elaborator::JoinObjects(const Tensor& flag, const BranchEnd& yes, const BranchEnd& no,
                             int count, Position position) {
  for (int object = 0; object < count; ++object) {
    const Object& a = yes.heap[object];
    const Object& b = no.heap[object];
    if (a.nodes == b.nodes && a.items == b.items && a.keys == b.keys) continue;
    Object joined;
    if (a.nodes != nullptr) {
      std::vector<NodeId> nodes = *a.nodes;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i] =
            graph_.Apply(ScalarOperation::kSelect, math_.At(flag, 0), nodes[i], (*b.nodes)[i]);
      }
      joined.nodes = std::make_shared<const std::vector<NodeId>>(std::move(nodes));
    } else if (a.keys != nullptr) {
      const Value dict = JoinDicts(flag, a, yes.heap, b, no.heap, position);
      joined = heap_[dict.object];
    } else {
      const Value left = TupleValue(*a.items), right = TupleValue(*b.items);
      const Value items = JoinItems(flag, {left, yes.heap}, {right, no.heap}, position);
      joined.items = items.Is(ValueKind::kTuple)
                         ? items.items
                         : std::make_shared<const std::vector<Value>>(1, items);
    }
    heap_.Set(object, std::move(joined));
  }
}

Value Elaborator::Choose(const Tensor& flag, const Value& yes, const Value& no, Position position) {
  const std::vector<Object> heap = heap_.Copy();
  steps_ += static_cast<int>(heap.size() / 16);
  return Join(flag, {yes, heap}, {no, heap}, position);
}

Value Elaborator::Join(const Tensor& flag, const Side& yes, const Side& no, Position position) {
  const Value& a = yes.value;
  const Value& b = no.value;
  Step(position);
  if (SameValue(a, b) && !a.Is(ValueKind::kTensor)) return a;
  if (a.Is(ValueKind::kUndefined)) return a;
  if (b.Is(ValueKind::kUndefined)) return b;
  const auto numeric = [](const Value& value) {
    return value.Is(ValueKind::kTensor) || value.IsNumber() || value.Is(ValueKind::kBatchSize);
  };
  if (numeric(a) && numeric(b)) return JoinTensors(flag, yes, no, position);
  if (a.kind == b.kind && a.Is(ValueKind::kTuple)) return JoinItems(flag, yes, no, position);
  if (a.kind == b.kind && a.Is(ValueKind::kDict)) {
    return JoinDicts(flag, yes.heap[a.object], yes.heap, no.heap[b.object], no.heap, position);
  }
  if (a.kind == b.kind && a.Is(ValueKind::kList)) {
    const Value left = TupleValue(*yes.heap[a.object].items);
    const Value right = TupleValue(*no.heap[b.object].items);
    const Value items = JoinItems(flag, {left, yes.heap}, {right, no.heap}, position);
    return items.Is(ValueKind::kTuple) ? NewList(*items.items) : items;
  }
  return Differs("this is " + Describe(a) + " or " + Describe(b) + ", by the condition in line " +
                 std::to_string(position.line) + "; both must be numbers");
}

Value Elaborator::JoinItems(const Tensor& flag, const Side& yes, const Side& no,
                            Position position) {
  const std::vector<Value>& a = *yes.value.items;
  const std::vector<Value>& b = *no.value.items;
  if (a.size() != b.size()) {
    return Differs("this has " + std::to_string(a.size()) + " or " + std::to_string(b.size()) +
                   " elements, by the condition in line " + std::to_string(position.line));
  }
  std::vector<Value> items;
  for (std::size_t i = 0; i < a.size(); ++i) {
    items.push_back(Join(flag, {a[i], yes.heap}, {b[i], no.heap}, position));
  }
  return TupleValue(std::move(items));
}

Value Elaborator::JoinDicts(const Tensor& flag, const Object& yes,
                            const std::vector<Object>& yes_heap, const Object& no,
                            const std::vector<Object>& no_heap, Position position) {
  std::vector<Value> keys = *yes.keys, items;
  for (const Value& key : *no.keys) {
    const bool known = std::any_of(keys.begin(), keys.end(),
                                   [&](const Value& other) { return SameValue(key, other); });
    if (!known) keys.push_back(key);
  }
  const auto find = [](const Object& object, const Value& key) -> const Value* {
    for (std::size_t i = 0; i < object.keys->size(); ++i) {
      if (SameValue((*object.keys)[i], key)) return &(*object.items)[i];
    }
    return nullptr;
  };
  for (const Value& key : keys) {
    const Value* a = find(yes, key);
    const Value* b = find(no, key);
    items.push_back(a != nullptr && b != nullptr
                        ? Join(flag, {*a, yes_heap}, {*b, no_heap}, position)
                        : Differs("the key '" + key.text +
                                  "' is set only where the condition in line " +
                                  std::to_string(position.line) + " goes one way"));
  }
  return NewDict(std::move(keys), std::move(items));
}

Value Elaborator::JoinTensors(const Tensor& flag, const Side& yes, const Side& no,
                              Position position) {
  const auto read = [&](const Side& side) {
    if (!side.value.Is(ValueKind::kTensor)) return math_.FromValue(side.value, position);
    const Tensor& tensor = *side.value.tensor;
    return math_.Make(tensor.type, tensor.shape, NodesIn(tensor, side.heap), position);
  };
  const Tensor a = read(yes), b = read(no);
  Shape shape = math_.Broadcast(a.shape, b.shape, position);
  // A scalar becomes one number per environment; a vector [3] stays the vector of one environment.
  if (shape.empty()) shape = flag.shape;
  const Tensor left = math_.Expand(a, shape, position), right = math_.Expand(b, shape, position);
  std::vector<NodeId> nodes = math_.Nodes(left);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] =
        graph_.Apply(ScalarOperation::kSelect, math_.At(flag, 0), nodes[i], math_.At(right, i));
  }
  return TensorValue(math_.Make(Promote(a.type, b.type), shape, std::move(nodes), position));
}

// Returns a copy that later modifications do not affect.
Value Elaborator::DeepCopy(const Value& value) {
  Step(returned_at_);
  if (value.Is(ValueKind::kTensor)) return TensorValue(math_.Copy(*value.tensor, {}));
  if (value.Is(ValueKind::kTuple)) {
    std::vector<Value> items;
    for (const Value& item : *value.items) items.push_back(DeepCopy(item));
    return TupleValue(std::move(items));
  }
  if (value.Is(ValueKind::kDict) || value.Is(ValueKind::kList)) {
    const Object object = heap_[value.object];
    std::vector<Value> items;
    for (const Value& item : *object.items) items.push_back(DeepCopy(item));
    return value.Is(ValueKind::kDict) ? NewDict(*object.keys, std::move(items))
                                      : NewList(std::move(items));
  }
  return value;
}

}  // namespace simwright::reward
