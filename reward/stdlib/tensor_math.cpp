#include "reward/stdlib/tensor_math.h"

#include <algorithm>
#include <numeric>

namespace simwright::reward {
namespace {

int LaneSize(int size) {
  return RunsOverEnvironments(size) ? 1 : size;
}

// Returns the distance in lanes of a step along each dimension.
std::vector<int> Strides(const Shape& shape) {
  std::vector<int> strides(shape.size());
  int stride = 1;
  for (std::size_t d = shape.size(); d-- > 0;) {
    strides[d] = stride;
    stride *= LaneSize(shape[d]);
  }
  return strides;
}

// Visits the lanes of `shape` in order; `visit` receives the sum of index * strides[d].
template <typename Visit>
void Walk(const Shape& shape, const std::vector<int>& strides, const Visit& visit) {
  const std::int64_t count = LaneCount(shape);
  std::vector<int> index(shape.size(), 0);
  int offset = 0;
  for (std::int64_t lane = 0; lane < count; ++lane) {
    visit(offset);
    for (std::size_t d = shape.size(); d-- > 0;) {
      offset += strides[d];
      if (++index[d] < LaneSize(shape[d])) break;
      offset -= strides[d] * LaneSize(shape[d]);
      index[d] = 0;
    }
  }
}

Tensor View(const Tensor& tensor, Shape shape, const std::vector<int>& strides, int start) {
  Tensor view{tensor.type, std::move(shape), tensor.storage, {}};
  view.lanes.reserve(static_cast<std::size_t>(LaneCount(view.shape)));
  Walk(view.shape, strides,
       [&](int offset) { view.lanes.push_back(tensor.lanes[start + offset]); });
  return view;
}

}  // namespace

DataType Promote(DataType a, DataType b) {
  return std::max(a, b);
}

Tensor TensorMath::Make(DataType type, Shape shape, std::vector<NodeId> nodes, Position position) {
  if (std::count_if(shape.begin(), shape.end(), RunsOverEnvironments) > 1) {
    Fail("two-batches", position,
         "this would make " + ShapeText(shape) +
             ", every environment against every other; keep one dimension of environments");
  }
  if (LaneCount(shape) > options_.max_lanes) {
    Fail("too-large", position,
         "a tensor " + ShapeText(shape) + " holds more than " + std::to_string(options_.max_lanes) +
             " numbers an environment");
  }
  Tensor tensor{type, std::move(shape), heap_.AddStorage({}), {}};
  tensor.lanes.resize(nodes.size());
  std::iota(tensor.lanes.begin(), tensor.lanes.end(), 0);
  Object storage;
  storage.nodes = std::make_shared<const std::vector<NodeId>>(std::move(nodes));
  heap_.Set(tensor.storage, std::move(storage));
  return tensor;
}

Tensor TensorMath::Full(DataType type, Shape shape, NodeId node, Position position) {
  const std::int64_t count = LaneCount(shape);
  if (count > options_.max_lanes) Make(type, shape, {}, position);  // throws
  return Make(type, std::move(shape), std::vector<NodeId>(static_cast<std::size_t>(count), node),
              position);
}

Tensor TensorMath::Scalar(DataType type, NodeId node) {
  return Make(type, {}, {node}, {});
}

NodeId TensorMath::At(const Tensor& tensor, std::size_t lane) const {
  return (*heap_[tensor.storage].nodes)[tensor.lanes[lane]];
}

std::vector<NodeId> TensorMath::Nodes(const Tensor& tensor) const {
  std::vector<NodeId> nodes(tensor.lanes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = At(tensor, i);
  return nodes;
}

void TensorMath::Write(const Tensor& tensor, const std::vector<NodeId>& values) {
  std::vector<NodeId> nodes = *heap_[tensor.storage].nodes;
  for (std::size_t i = 0; i < tensor.lanes.size(); ++i) nodes[tensor.lanes[i]] = values[i];
  Object storage;
  storage.nodes = std::make_shared<const std::vector<NodeId>>(std::move(nodes));
  heap_.Set(tensor.storage, std::move(storage));
}

Tensor TensorMath::FromValue(const Value& value, Position position) {
  if (value.Is(ValueKind::kTensor)) return *value.tensor;
  if (value.IsNumber()) return Scalar(value.NumberType(), graph_.Constant(value.Number()));
  if (value.Is(ValueKind::kBatchSize)) return Scalar(DataType::kInteger, graph_.BatchSize());
  if (value.Is(ValueKind::kUndefined)) {
    Fail(value.text.empty() ? "" : "undefined", position, value.text);
  }
  Fail("not-a-tensor", position, "a tensor or a number is wanted here, this is " + Describe(value));
}

Tensor TensorMath::Cast(const Tensor& tensor, DataType type, Position position) {
  if (tensor.type == type) return tensor;
  std::vector<NodeId> nodes = Nodes(tensor);
  for (NodeId& node : nodes) {
    if (type == DataType::kBool) {
      node = graph_.Apply(ScalarOperation::kNotEqual, node, graph_.Constant(0.0));
    } else if (type == DataType::kInteger && tensor.type == DataType::kFloat) {
      node = graph_.Apply(ScalarOperation::kTruncate, node);
    }
  }
  return Make(type, tensor.shape, std::move(nodes), position);
}

Tensor TensorMath::Map(ScalarOperation operation, const Tensor& a, DataType type,
                       Position position) {
  std::vector<NodeId> nodes = Nodes(a);
  for (NodeId& node : nodes) node = graph_.Apply(operation, node);
  return Make(type, a.shape, std::move(nodes), position);
}

Tensor TensorMath::Map(ScalarOperation operation, const Tensor& a, const Tensor& b, DataType type,
                       Position position) {
  const Shape shape = Broadcast(a.shape, b.shape, position);
  const Tensor left = Expand(a, shape, position), right = Expand(b, shape, position);
  std::vector<NodeId> nodes(left.lanes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = graph_.Apply(operation, At(left, i), At(right, i));
  }
  return Make(type, shape, std::move(nodes), position);
}

Tensor TensorMath::Select(const Tensor& condition, const Tensor& a, const Tensor& b,
                          Position position) {
  const Shape shape = Broadcast(Broadcast(a.shape, b.shape, position), condition.shape, position);
  const Tensor choice = Expand(condition, shape, position);
  const Tensor yes = Expand(a, shape, position), no = Expand(b, shape, position);
  std::vector<NodeId> nodes(choice.lanes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = graph_.Apply(ScalarOperation::kSelect, At(choice, i), At(yes, i), At(no, i));
  }
  return Make(Promote(a.type, b.type), shape, std::move(nodes), position);
}

Shape TensorMath::Broadcast(const Shape& a, const Shape& b, Position position) const {
  const std::size_t rank = std::max(a.size(), b.size());
  Shape shape(rank);
  for (std::size_t d = 0; d < rank; ++d) {
    const int left = d + a.size() < rank ? 1 : a[d + a.size() - rank];
    const int right = d + b.size() < rank ? 1 : b[d + b.size() - rank];
    if (left != right && left != 1 && right != 1) {
      std::string hint;
      if (IsSelected(left) || IsSelected(right)) {
        hint = "; M are the environments that a mask picks: use torch.where(mask, a, b)";
      } else if (a.size() != b.size() && (left == kBatch || right == kBatch)) {
        hint = "; a row of environments needs .unsqueeze(-1) to meet a table of them";
      }
      Fail("shape", position,
           "shapes " + ShapeText(a) + " and " + ShapeText(b) + " do not fit together" + hint);
    }
    shape[d] = left == 1 ? right : left;
  }
  if (std::count_if(shape.begin(), shape.end(), RunsOverEnvironments) > 1) {
    Fail("two-batches", position,
         "shapes " + ShapeText(a) + " and " + ShapeText(b) + " would make " + ShapeText(shape) +
             ", every environment against every other; give both the same dimensions "
             "(.unsqueeze(-1) or .squeeze(-1))");
  }
  if (LaneCount(shape) > options_.max_lanes) {
    Fail("too-large", position,
         "a tensor " + ShapeText(shape) + " holds more than " + std::to_string(options_.max_lanes) +
             " numbers an environment");
  }
  return shape;
}

Tensor TensorMath::Expand(const Tensor& tensor, const Shape& shape, Position position) const {
  if (tensor.shape == shape) return tensor;
  if (tensor.shape.size() > shape.size() || Broadcast(tensor.shape, shape, position) != shape) {
    Fail("shape", position,
         "a tensor " + ShapeText(tensor.shape) + " does not fit into " + ShapeText(shape));
  }
  const std::vector<int> own = Strides(tensor.shape);
  const std::size_t lead = shape.size() - tensor.shape.size();
  std::vector<int> strides(shape.size(), 0);
  for (std::size_t d = 0; d < own.size(); ++d) {
    if (LaneSize(tensor.shape[d]) > 1) strides[lead + d] = own[d];
  }
  return View(tensor, shape, strides, 0);
}

int TensorMath::Dimension(std::int64_t dimension, std::size_t rank, Position position) const {
  const auto count = static_cast<std::int64_t>(rank);
  if (dimension < -count || dimension >= count) {
    Fail("dimension", position,
         "there is no dimension " + std::to_string(dimension) + ": the tensor has " +
             (count == 0 ? std::string("none, it is a scalar") : std::to_string(count)));
  }
  return static_cast<int>(dimension < 0 ? dimension + count : dimension);
}

Tensor TensorMath::Take(const Tensor& tensor, int dimension, std::int64_t index,
                        Position position) {
  const int size = tensor.shape[dimension];
  Shape shape = tensor.shape;
  shape.erase(shape.begin() + dimension);
  if (IsSelected(size)) {
    Fail("index", position,
         "which environments a mask picks is not known before, so none of them can be taken; "
         "reduce them with .mean(), .sum(), .max()");
  }
  if (size == kBatch) {  // the numbers of one environment, for all
    std::vector<NodeId> nodes = Nodes(tensor);
    if (index < -1'000'000 || index > 1'000'000) {
      Fail("index", position, "there is no environment " + std::to_string(index));
    }
    for (NodeId& node : nodes) node = graph_.Pick(node, static_cast<int>(index));
    return Make(tensor.type, std::move(shape), std::move(nodes), position);
  }
  if (index < -size || index >= size) {
    Fail("index", position,
         "there is no element " + std::to_string(index) + " in dimension " +
             std::to_string(dimension) + " of " + ShapeText(tensor.shape) + "; the last is " +
             std::to_string(size - 1));
  }
  std::vector<int> strides = Strides(tensor.shape);
  const int start = strides[dimension] * static_cast<int>(index < 0 ? index + size : index);
  strides.erase(strides.begin() + dimension);
  return View(tensor, std::move(shape), strides, start);
}

Tensor TensorMath::Slice(const Tensor& tensor, int dimension, std::int64_t start, std::int64_t stop,
                         std::int64_t step) const {
  std::vector<int> strides = Strides(tensor.shape);
  Shape shape = tensor.shape;
  const int stride = strides[dimension];
  shape[dimension] = static_cast<int>(std::max<std::int64_t>(0, (stop - start + step - 1) / step));
  strides[dimension] = stride * static_cast<int>(step);
  return View(tensor, std::move(shape), strides, stride * static_cast<int>(start));
}

Tensor TensorMath::Unsqueeze(const Tensor& tensor, int dimension) const {
  Tensor view = tensor;
  view.shape.insert(view.shape.begin() + dimension, 1);
  return view;
}

Tensor TensorMath::Squeeze(const Tensor& tensor, int dimension) const {
  Tensor view = tensor;
  if (view.shape[dimension] == 1) view.shape.erase(view.shape.begin() + dimension);
  return view;
}

Tensor TensorMath::Permute(const Tensor& tensor, const std::vector<int>& order) const {
  const std::vector<int> own = Strides(tensor.shape);
  Shape shape;
  std::vector<int> strides;
  for (const int d : order) {
    shape.push_back(tensor.shape[d]);
    strides.push_back(own[d]);
  }
  return View(tensor, std::move(shape), strides, 0);
}

Tensor TensorMath::Reshape(const Tensor& tensor, const std::vector<std::int64_t>& sizes,
                           Position position) {
  if (HasSelectedDimension(tensor.shape)) {
    Fail("shape", position, "what a mask picks keeps its shape " + ShapeText(tensor.shape));
  }
  const int batch = BatchDimension(tensor.shape);
  const std::int64_t lanes = LaneCount(tensor.shape);
  std::int64_t product = 1;
  Shape shape;
  int open = -1;
  bool has_batch = false;
  for (const std::int64_t size : sizes) {
    const int at = static_cast<int>(shape.size());
    if (size == -1 && open < 0)
      open = at;
    else if (size == -1)
      Fail("shape", position, "only one size may be -1");
    has_batch = has_batch || size == kKnownBatch;
    if (size == 0 || size < kKnownBatch || size > options_.max_lanes) {
      Fail("shape", position, "a size of " + std::to_string(size) + " is not possible");
    }
    if (size > 0) product = std::min<std::int64_t>(product * size, 1LL << 40);
    shape.push_back(size == kKnownBatch ? kBatch
                                        : static_cast<int>(std::max<std::int64_t>(size, 1)));
  }
  if (open >= 0 && batch >= 0 && !has_batch)
    shape[open] = kBatch;
  else if (open >= 0 && product > 0)
    shape[open] = static_cast<int>(lanes / product);
  const int to = BatchDimension(shape);
  const auto before = [](const Shape& of, int dimension) {
    return LaneCount(Shape(of.begin(), of.begin() + std::max(0, dimension)));
  };
  if (LaneCount(shape) != lanes || (to < 0) != (batch < 0) ||
      std::count(shape.begin(), shape.end(), kBatch) > 1 ||
      before(shape, to) != before(tensor.shape, batch)) {
    Fail("shape", position,
         "a tensor " + ShapeText(tensor.shape) +
             " cannot be reshaped to this; the product of the "
             "sizes must stay, and N must keep its place");
  }
  Tensor view = tensor;
  view.shape = std::move(shape);
  return view;
}

Tensor TensorMath::Concatenate(const std::vector<Tensor>& tensors, int dimension,
                               Position position) {
  Shape shape = tensors[0].shape;
  DataType type = DataType::kBool;
  int total = 0;
  for (const Tensor& tensor : tensors) {
    type = Promote(type, tensor.type);
    bool fits = tensor.shape.size() == shape.size();
    for (std::size_t d = 0; fits && d < shape.size(); ++d) {
      fits = static_cast<int>(d) == dimension || tensor.shape[d] == shape[d];
    }
    if (!fits) {
      Fail("shape", position,
           "shapes " + ShapeText(shape) + " and " + ShapeText(tensor.shape) +
               " cannot be joined along dimension " + std::to_string(dimension));
    }
    if (RunsOverEnvironments(tensor.shape[dimension])) {
      Fail("shape", position,
           "joining along the environments would change their number; join along the last "
           "dimension (dim=-1)");
    }
    total += tensor.shape[dimension];
  }
  shape[dimension] = total;
  if (LaneCount(shape) > options_.max_lanes) Make(type, shape, {}, position);  // throws
  std::vector<NodeId> nodes(static_cast<std::size_t>(LaneCount(shape)));
  const std::vector<int> strides = Strides(shape);
  int start = 0;
  for (const Tensor& tensor : tensors) {
    std::size_t lane = 0;
    Walk(tensor.shape, strides,
         [&](int offset) { nodes[start * strides[dimension] + offset] = At(tensor, lane++); });
    start += tensor.shape[dimension];
  }
  return Make(type, std::move(shape), std::move(nodes), position);
}

Tensor TensorMath::Copy(const Tensor& tensor, Position position) {
  return Make(tensor.type, tensor.shape, Nodes(tensor), position);
}

}  // namespace simwright::reward
