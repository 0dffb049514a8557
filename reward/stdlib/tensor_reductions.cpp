#include <algorithm>
#include <cmath>

#include "reward/stdlib/tensor_math.h"

namespace simwright::reward {
namespace {

bool ContainsAxis(const std::vector<int>& all, int one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

// Returns for each lane the result lane into which it is reduced.
std::vector<int> Targets(const Shape& shape, const std::vector<int>& dimensions) {
  std::vector<int> sizes(shape.size()), strides(shape.size(), 0);
  int stride = 1;
  for (std::size_t d = shape.size(); d-- > 0;) {
    sizes[d] = RunsOverEnvironments(shape[d]) ? 1 : shape[d];
    if (ContainsAxis(dimensions, static_cast<int>(d))) continue;
    strides[d] = stride;
    stride *= sizes[d];
  }
  std::vector<int> targets(static_cast<std::size_t>(LaneCount(shape)));
  for (std::size_t lane = 0; lane < targets.size(); ++lane) {
    int rest = static_cast<int>(lane);
    for (std::size_t d = shape.size(); d-- > 0;) {
      targets[lane] += rest % sizes[d] * strides[d];
      rest /= sizes[d];
    }
  }
  return targets;
}

// Returns the neutral element of a reduction, used for environments that a mask excludes.
double Neutral(Reduction reduction) {
  switch (reduction) {
    case Reduction::kMinimum:
      return HUGE_VAL;
    case Reduction::kMaximum:
      return -HUGE_VAL;
    case Reduction::kProduct:
    case Reduction::kAll:
      return 1.0;
    default:
      return 0.0;
  }
}

}  // namespace

NodeId TensorMath::Combine(Reduction reduction, NodeId a, NodeId b) {
  using enum ScalarOperation;
  switch (reduction) {
    case Reduction::kSum:
      return graph_.Apply(kAdd, a, b);
    case Reduction::kProduct:
      return graph_.Apply(kMultiply, a, b);
    case Reduction::kMinimum:
      return graph_.Apply(kMinimum, a, b);
    case Reduction::kMaximum:
      return graph_.Apply(kMaximum, a, b);
    case Reduction::kAll:
      return graph_.Apply(kAnd, a, b);
    case Reduction::kAny:
      break;
  }
  return graph_.Apply(kOr, a, b);
}

NodeId TensorMath::OverBatch(Reduction reduction, NodeId a, Position position) {
  switch (reduction) {
    case Reduction::kSum:
      return graph_.Apply(ScalarOperation::kBatchSum, a);
    case Reduction::kMinimum:
    case Reduction::kAll:
      return graph_.Apply(ScalarOperation::kBatchMinimum, a);
    case Reduction::kMaximum:
    case Reduction::kAny:
      return graph_.Apply(ScalarOperation::kBatchMaximum, a);
    case Reduction::kProduct:
      break;
  }
  Fail("unsupported", position,
       "a product over all environments is not offered; name another dimension with dim=");
}

Tensor TensorMath::Reduce(Reduction reduction, const Tensor& tensor,
                          const std::vector<int>& dimensions, bool keep, Position position) {
  const bool flags = reduction == Reduction::kAll || reduction == Reduction::kAny;
  const Tensor operand = flags ? Cast(tensor, DataType::kBool, position) : tensor;
  Shape shape;
  for (std::size_t d = 0; d < operand.shape.size(); ++d) {
    if (!ContainsAxis(dimensions, static_cast<int>(d))) {
      shape.push_back(operand.shape[d]);
    } else if (keep) {
      shape.push_back(1);
    }
  }
  std::vector<NodeId> nodes(static_cast<std::size_t>(LaneCount(shape)), -1);
  const std::vector<int> targets = Targets(operand.shape, dimensions);
  for (std::size_t lane = 0; lane < targets.size(); ++lane) {
    NodeId& node = nodes[targets[lane]];
    node = node < 0 ? At(operand, lane) : Combine(reduction, node, At(operand, lane));
  }
  const auto over = std::find_if(dimensions.begin(), dimensions.end(),
                                 [&](int d) { return RunsOverEnvironments(operand.shape[d]); });
  for (NodeId& node : nodes) {
    if (node < 0) {  // an empty reduction
      if (reduction == Reduction::kMinimum || reduction == Reduction::kMaximum) {
        Fail("shape", position, "there is nothing to take the least or largest of");
      }
      const bool one = reduction == Reduction::kProduct || reduction == Reduction::kAll;
      node = graph_.Constant(one ? 1.0 : 0.0);
    }
    if (over == dimensions.end()) continue;
    const int size = operand.shape[*over];
    if (IsSelected(size)) {
      node = graph_.Apply(ScalarOperation::kSelect, SelectionFlag(size), node,
                          graph_.Constant(Neutral(reduction)));
    }
    node = OverBatch(reduction, node, position);
  }
  DataType type = flags ? DataType::kBool : tensor.type;
  const bool adds = reduction == Reduction::kSum || reduction == Reduction::kProduct;
  if (adds && type == DataType::kBool) type = DataType::kInteger;
  return Make(type, std::move(shape), std::move(nodes), position);
}

NodeId TensorMath::CountOver(const Tensor& tensor, const std::vector<int>& dimensions) {
  double count = 1.0;
  NodeId rows = -1;
  for (const int d : dimensions) {
    if (!RunsOverEnvironments(tensor.shape[d])) {
      count *= tensor.shape[d];
      continue;
    }
    rows = IsSelected(tensor.shape[d])
               ? graph_.Apply(ScalarOperation::kBatchSum, SelectionFlag(tensor.shape[d]))
               : graph_.BatchSize();
  }
  const NodeId lanes = graph_.Constant(count);
  return rows < 0 ? lanes : graph_.Apply(ScalarOperation::kMultiply, lanes, rows);
}

Tensor TensorMath::Mean(const Tensor& tensor, const std::vector<int>& dimensions, bool keep,
                        Position position) {
  const Tensor sum = Reduce(Reduction::kSum, tensor, dimensions, keep, position);
  const Tensor count = Scalar(DataType::kFloat, CountOver(tensor, dimensions));
  return Map(ScalarOperation::kDivide, sum, count, DataType::kFloat, position);
}

}  // namespace simwright::reward
