#pragma once

#include <cstdint>
#include <vector>

#include "reward/ir/graph.h"
#include "reward/reward_options.h"
#include "reward/symbolic/value.h"

namespace simwright::reward {

enum class Reduction { kSum, kProduct, kMinimum, kMaximum, kAll, kAny };

// Torch's tensor operations, applied to the lanes of a graph. Shapes and types are known at compile
// time, so broadcasting, views, reductions and rearrangements cost nothing at run time. Operations
// throw Fault at `position` for invalid arguments.
class TensorMath {
 public:
  TensorMath(const RewardOptions& options, Graph* graph, Heap* heap)
      : options_(options), graph_(*graph), heap_(*heap) {}

  Graph& graph() { return graph_; }
  Heap& heap() { return heap_; }

  // Returns a new tensor with its own storage. Rejects two dimensions N and too many lanes.
  Tensor Make(DataType type, Shape shape, std::vector<NodeId> nodes, Position position);
  Tensor Full(DataType type, Shape shape, NodeId node, Position position);
  Tensor Scalar(DataType type, NodeId node);
  std::vector<NodeId> Nodes(const Tensor& tensor) const;
  NodeId At(const Tensor& tensor, std::size_t lane) const;
  // Writes `values` (as many as lanes) into the storage that the tensor views.
  void Write(const Tensor& tensor, const std::vector<NodeId>& values);

  // Returns a number, a flag or the number of environments as a scalar tensor, and a tensor
  // unchanged.
  Tensor FromValue(const Value& value, Position position);

  Tensor Cast(const Tensor& tensor, DataType type, Position position);
  Tensor Map(ScalarOperation operation, const Tensor& a, DataType type, Position position);
  Tensor Map(ScalarOperation operation, const Tensor& a, const Tensor& b, DataType type,
             Position position);
  Tensor Select(const Tensor& condition, const Tensor& a, const Tensor& b, Position position);

  // Returns the shape that torch's broadcasting gives.
  Shape Broadcast(const Shape& a, const Shape& b, Position position) const;
  // Returns a view of the tensor with the given shape, to which it must be broadcastable.
  Tensor Expand(const Tensor& tensor, const Shape& shape, Position position) const;

  // Reduces over the given dimensions (checked, in order). Without dimensions returns the tensor
  // itself.
  Tensor Reduce(Reduction reduction, const Tensor& tensor, const std::vector<int>& dimensions,
                bool keep, Position position);
  // Returns the number of elements that a reduction over the dimensions combines, as a node; N is
  // included.
  NodeId CountOver(const Tensor& tensor, const std::vector<int>& dimensions);
  Tensor Mean(const Tensor& tensor, const std::vector<int>& dimensions, bool keep,
              Position position);

  // Views of a tensor.
  Tensor Take(const Tensor& tensor, int dimension, std::int64_t index, Position position);
  Tensor Slice(const Tensor& tensor, int dimension, std::int64_t start, std::int64_t stop,
               std::int64_t step) const;
  Tensor Unsqueeze(const Tensor& tensor, int dimension) const;
  Tensor Squeeze(const Tensor& tensor, int dimension) const;
  Tensor Permute(const Tensor& tensor, const std::vector<int>& order) const;
  // -1 represents a size that follows from the others; kKnownBatch represents N.
  Tensor Reshape(const Tensor& tensor, const std::vector<std::int64_t>& sizes, Position position);

  Tensor Concatenate(const std::vector<Tensor>& tensors, int dimension, Position position);
  Tensor Copy(const Tensor& tensor, Position position);

  // Returns the dimension's index; a negative one counts from the end. Throws Fault if there is no
  // such dimension.
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

}  // namespace simwright::reward
