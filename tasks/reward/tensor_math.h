#pragma once

#include <cstdint>
#include <vector>

#include "tasks/reward/graph.h"
#include "tasks/reward/reward_options.h"
#include "tasks/reward/value.h"

namespace simwright::tasks::reward {

enum class Reduction { kSum, kProduct, kMinimum, kMaximum, kAll, kAny };

// Torch's tensor operations, carried out on the lanes of a graph. Shapes and types are known, so
// broadcasting, views, reductions and rearrangements cost nothing when the program runs.
// Everything that can be wrong throws Fault at `position`.
class TensorMath {
 public:
  TensorMath(const RewardOptions& options, Graph* graph, Heap* heap)
      : options_(options), graph_(*graph), heap_(*heap) {}

  Graph& graph() { return graph_; }
  Heap& heap() { return heap_; }

  // A new tensor with its own storage. Refuses two dimensions N and too many lanes.
  Tensor Make(DataType type, Shape shape, std::vector<NodeId> nodes, Position position);
  Tensor Full(DataType type, Shape shape, NodeId node, Position position);
  Tensor Scalar(DataType type, NodeId node);
  std::vector<NodeId> Nodes(const Tensor& tensor) const;
  NodeId At(const Tensor& tensor, std::size_t lane) const;
  // Writes `values` (as many as lanes) into the storage that the tensor looks at.
  void Write(const Tensor& tensor, const std::vector<NodeId>& values);

  // A number, a flag or the number of environments as a scalar tensor; a tensor as it is.
  Tensor FromValue(const Value& value, Position position);

  Tensor Cast(const Tensor& tensor, DataType type, Position position);
  Tensor Map(ScalarOperation operation, const Tensor& a, DataType type, Position position);
  Tensor Map(ScalarOperation operation, const Tensor& a, const Tensor& b, DataType type,
             Position position);
  Tensor Select(const Tensor& condition, const Tensor& a, const Tensor& b, Position position);

  // Torch's broadcasting; `sign` names the operation in the sentence.
  Shape Broadcast(const Shape& a, const Shape& b, Position position) const;
  // A view of the tensor with the shape, which it must broadcast to.
  Tensor Expand(const Tensor& tensor, const Shape& shape, Position position) const;

  // Over the given dimensions (checked, in order); over none of them: the tensor itself.
  Tensor Reduce(Reduction reduction, const Tensor& tensor, const std::vector<int>& dimensions,
                bool keep, Position position);
  // How many numbers a reduction over the dimensions takes together, as a node: N counts.
  NodeId CountOver(const Tensor& tensor, const std::vector<int>& dimensions);
  Tensor Mean(const Tensor& tensor, const std::vector<int>& dimensions, bool keep,
              Position position);

  // Views.
  Tensor Take(const Tensor& tensor, int dimension, std::int64_t index, Position position);
  Tensor Slice(const Tensor& tensor, int dimension, std::int64_t start, std::int64_t stop,
               std::int64_t step) const;
  Tensor Unsqueeze(const Tensor& tensor, int dimension) const;
  Tensor Squeeze(const Tensor& tensor, int dimension) const;
  Tensor Permute(const Tensor& tensor, const std::vector<int>& order) const;
  // -1 for a size that follows from the others; kKnownBatch stands for N.
  Tensor Reshape(const Tensor& tensor, const std::vector<std::int64_t>& sizes, Position position);

  Tensor Concatenate(const std::vector<Tensor>& tensors, int dimension, Position position);
  Tensor Copy(const Tensor& tensor, Position position);

  // Counts from the end where negative; throws where there is no such dimension.
  int Dimension(std::int64_t dimension, std::size_t rank, Position position) const;

  static constexpr std::int64_t kKnownBatch = -2;

 private:
  NodeId Combine(Reduction reduction, NodeId a, NodeId b);
  NodeId OverBatch(Reduction reduction, NodeId a, Position position);

  const RewardOptions& options_;
  Graph& graph_;
  Heap& heap_;
};

DataType Promote(DataType a, DataType b);

}  // namespace simwright::tasks::reward
