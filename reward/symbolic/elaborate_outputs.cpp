#include <algorithm>

#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

void WantAllEnvironments(const Tensor& tensor, const char* code, const std::string& what,
                         Position position) {
  if (!HasSelectedDimension(tensor.shape)) return;
  Fail(code, position,
       what + " is " + ShapeText(tensor.shape) +
           ", what a mask picks, and not every environment has one; use torch.where(mask, a, b)");
}

}  // namespace

NodeId Elaborator::RewardNode(const Value& value, Position position) {
  if (!value.IsNumber() && !value.Is(ValueKind::kTensor)) {
    if (value.Is(ValueKind::kUndefined)) math_.FromValue(value, position);
    Fail("bad-reward", position,
         "the reward has to be a number an environment, this is " + Describe(value));
  }
  const Tensor tensor = math_.FromValue(value, position);
  if (tensor.shape != Shape{kBatch} && !tensor.shape.empty()) {
    const bool column = tensor.lanes.size() == 1;
    WantAllEnvironments(tensor, "bad-reward", "the reward", position);
    Fail("bad-reward", position,
         "the reward has to be one number an environment, [N]; this is " + ShapeText(tensor.shape) +
             (column ? "; use .squeeze(-1)" : "; sum it with .sum(dim=-1)"));
  }
  const NodeId node = math_.At(tensor, 0);
  if (graph_.IsConstant(node)) {
    Report("constant-reward", core::Severity::kWarning, position,
           "the reward is the same number whatever happens: nothing can be learned from it");
  } else if (graph_[node].uniform) {
    Report("shared-reward", core::Severity::kWarning, position,
           "the reward is one number for all environments; did a mean or sum go over them? Name "
           "the dimension, dim=-1");
  }
  return node;
}

NodeId Elaborator::SuccessNode(const Value& value, Position position) {
  if (!value.IsNumber() && !value.Is(ValueKind::kTensor)) {
    if (value.Is(ValueKind::kUndefined)) math_.FromValue(value, position);
    Fail("bad-success", position,
         "success has to be true or false an environment, this is " + Describe(value));
  }
  const Tensor flag = math_.Cast(math_.FromValue(value, position), DataType::kBool, position);
  WantAllEnvironments(flag, "bad-success", "success", position);
  if (flag.shape != Shape{kBatch} && !flag.shape.empty()) {
    Fail("bad-success", position,
         "success has to be one flag an environment, [N]; this is " + ShapeText(flag.shape) +
             "; use .all(dim=-1)");
  }
  const NodeId node = math_.At(flag, 0);
  if (graph_.IsConstant(node)) {
    Report("constant-success", core::Severity::kWarning, position,
           "success is the same whatever happens");
  }
  return node;
}

void Elaborator::Components(const Value& value, Position position, ElaboratedOutputs* outputs) {
  const Object& dict = heap_[value.object];
  for (std::size_t i = 0; i < dict.keys->size(); ++i) {
    const Value& key = (*dict.keys)[i];
    const Value& item = (*dict.items)[i];
    if (!key.Is(ValueKind::kString)) {
      Fail("bad-key", position, "the components of a reward are named by strings");
    }
    if (item.Is(ValueKind::kUndefined)) math_.FromValue(item, position);
    if (!item.IsNumber() && !item.Is(ValueKind::kTensor) && !item.Is(ValueKind::kBatchSize)) {
      Fail("bad-component", position,
           "the component '" + key.text + "' has to be numbers, this is " + Describe(item));
    }
    if (item.Is(ValueKind::kTensor)) {
      WantAllEnvironments(*item.tensor, "bad-component", "the component '" + key.text + "'",
                          position);
    }
    outputs->components.push_back({key.text, math_.Nodes(math_.FromValue(item, position))});
  }
}

ElaboratedOutputs Elaborator::Outputs(const Value& result, Position position) {
  ElaboratedOutputs outputs;
  if (result.Is(ValueKind::kNone)) {
    Fail("no-return", position,
         "the function returns nothing; end it with 'return reward' or 'return reward, success'");
  }
  if (!result.Is(ValueKind::kTuple)) {
    outputs.reward = RewardNode(result, position);
    return outputs;
  }
  if (result.items->size() != 2) {
    Fail("bad-return", position,
         "the function returns " + std::to_string(result.items->size()) +
             " values; a reward, (reward, success) or (reward, dictionary of components) is "
             "wanted");
  }
  outputs.reward = RewardNode((*result.items)[0], position);
  const Value& second = (*result.items)[1];
  if (second.Is(ValueKind::kDict)) {
    Components(second, position, &outputs);
  } else {
    outputs.success = SuccessNode(second, position);
  }
  return outputs;
}

}  // namespace simwright::reward
