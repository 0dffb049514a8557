#include <algorithm>
#include <numeric>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

std::vector<Tensor> TensorList(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Tensor> tensors;
  for (const Value& item : elaborator.Items(arguments[0], arguments.Place(0))) {
    if (WantsTensors(arguments) && !item.Is(ValueKind::kTensor)) {
      if (item.Is(ValueKind::kUndefined)) elaborator.math().FromValue(item, arguments.Place(0));
      Fail("type", arguments.Place(0),
           "'" + arguments.called + "' joins tensors, one of these is " + Describe(item));
    }
    tensors.push_back(ArrayFrom(elaborator, item, arguments.Place(0)));
  }
  if (tensors.empty()) Fail("arguments", arguments.Place(0), "there is nothing to join");
  return tensors;
}

// Returns the same call with a second argument, the dimension.
Arguments WithDimension(Arguments arguments, std::int64_t dimension) {
  arguments.values.push_back(IntegerValue(dimension));
  arguments.places.push_back(arguments.position);
  arguments.given.push_back(true);
  return arguments;
}

Value Stack(Elaborator& elaborator, const Arguments& arguments) {
  std::vector<Tensor> tensors = TensorList(elaborator, arguments);
  const std::int64_t at = IntegerArgument(elaborator, arguments, 1);
  const int dimension =
      elaborator.math().Dimension(at, tensors[0].shape.size() + 1, arguments.Place(1));
  for (Tensor& tensor : tensors) {
    if (tensor.shape != tensors[0].shape) {
      Fail("shape", arguments.Place(0),
           "shapes " + ShapeText(tensors[0].shape) + " and " + ShapeText(tensor.shape) +
               " cannot be stacked; they have to be equal");
    }
  }
  for (Tensor& tensor : tensors) tensor = elaborator.math().Unsqueeze(tensor, dimension);
  return TensorValue(elaborator.math().Concatenate(tensors, dimension, arguments.position));
}

Value Concatenate(Elaborator& elaborator, const Arguments& arguments) {
  const std::vector<Tensor> tensors = TensorList(elaborator, arguments);
  const int dimension = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1),
                                                    tensors[0].shape.size(), arguments.Place(1));
  return TensorValue(elaborator.math().Concatenate(tensors, dimension, arguments.position));
}

Value Unsqueeze(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const int dimension = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1),
                                                    tensor.shape.size() + 1, arguments.Place(1));
  return TensorValue(elaborator.math().Unsqueeze(tensor, dimension));
}

Value Squeeze(Elaborator& elaborator, const Arguments& arguments) {
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<int> dimensions = Dimensions(elaborator, arguments, 1, tensor);
  for (std::size_t i = dimensions.size(); i-- > 0;) {
    tensor = elaborator.math().Squeeze(tensor, dimensions[i]);
  }
  return TensorValue(std::move(tensor));
}

Value Transpose(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::size_t rank = tensor.shape.size();
  std::vector<int> order(rank);
  std::iota(order.begin(), order.end(), 0);
  std::swap(order[elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1), rank,
                                              arguments.Place(1))],
            order[elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 2), rank,
                                              arguments.Place(2))]);
  return TensorValue(elaborator.math().Permute(tensor, order));
}

Value Permute(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<int> order;
  for (const std::int64_t one : Sizes(elaborator, arguments[1], arguments.Place(1))) {
    const int dimension = elaborator.math().Dimension(one, tensor.shape.size(), arguments.Place(1));
    if (std::find(order.begin(), order.end(), dimension) == order.end()) order.push_back(dimension);
  }
  if (order.size() != tensor.shape.size()) {
    Fail("dimension", arguments.Place(1),
         "every dimension of " + ShapeText(tensor.shape) + " has to be named once");
  }
  return TensorValue(elaborator.math().Permute(tensor, order));
}

Value Reshape(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::vector<std::int64_t> sizes = Sizes(elaborator, arguments[1], arguments.Place(1));
  return TensorValue(elaborator.math().Reshape(tensor, sizes, arguments.position));
}

Value ReshapeAs(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<std::int64_t> sizes;
  for (const int size : TensorArgument(elaborator, arguments, 1).shape) {
    sizes.push_back(size == kBatch ? TensorMath::kKnownBatch : size);
  }
  return TensorValue(elaborator.math().Reshape(tensor, sizes, arguments.position));
}

Value SwapTwo(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  if (tensor.shape.size() < 2) return TensorValue(tensor);
  if (tensor.shape.size() > 2) {
    Fail("dimension", arguments.position,
         "'" + arguments.called + "' turns a table, this is " + ShapeText(tensor.shape) +
             "; use .transpose(1, 2)");
  }
  return TensorValue(elaborator.math().Permute(tensor, {1, 0}));
}

// Concatenates along the last of one or two dimensions.
Value ShapeColumns(Elaborator& elaborator, const Arguments& arguments) {
  const std::vector<Tensor> tensors = TensorList(elaborator, arguments);
  const int dimension = tensors[0].shape.size() < 2 ? 0 : 1;
  if (tensors[0].shape.empty()) return Stack(elaborator, WithDimension(arguments, 0));
  return TensorValue(elaborator.math().Concatenate(tensors, dimension, arguments.position));
}

// Stacks vertically; vectors become rows.
Value Rows(Elaborator& elaborator, const Arguments& arguments) {
  const std::vector<Tensor> tensors = TensorList(elaborator, arguments);
  if (tensors[0].shape.size() < 2) return Stack(elaborator, WithDimension(arguments, 0));
  return TensorValue(elaborator.math().Concatenate(tensors, 0, arguments.position));
}

Value Flatten(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::size_t rank = tensor.shape.size();
  if (rank == 0) return TensorValue(elaborator.math().Unsqueeze(tensor, 0));
  const int first = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1), rank,
                                                arguments.Place(1));
  const int last = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 2), rank,
                                               arguments.Place(2));
  std::vector<std::int64_t> sizes;
  for (int d = 0; d < static_cast<int>(rank); ++d) {
    if (d > first && d <= last) continue;
    const int size = tensor.shape[d];
    if (d == first && last > first)
      sizes.push_back(-1);
    else
      sizes.push_back(size == kBatch ? TensorMath::kKnownBatch : size);
  }
  return TensorValue(elaborator.math().Reshape(tensor, sizes, arguments.position));
}

Value Expand(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  Shape shape;
  const std::vector<std::int64_t> sizes = Sizes(elaborator, arguments[1], arguments.Place(1));
  for (std::size_t d = 0; d < sizes.size(); ++d) {
    const std::size_t lead = sizes.size() - tensor.shape.size();
    if (sizes[d] != -1) {
      shape.push_back(sizes[d] == TensorMath::kKnownBatch ? kBatch : static_cast<int>(sizes[d]));
    } else if (sizes.size() >= tensor.shape.size() && d >= lead) {
      shape.push_back(tensor.shape[d - lead]);
    } else {
      Fail("shape", arguments.Place(1), "a size of -1 has no dimension to keep here");
    }
  }
  return TensorValue(elaborator.math().Expand(tensor, shape, arguments.position));
}

Value ExpandAs(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Tensor other = TensorArgument(elaborator, arguments, 1);
  return TensorValue(elaborator.math().Expand(tensor, other.shape, arguments.position));
}

// Implements x.repeat(n, 1): repeats along each dimension; new dimensions come first.
Value Repeat(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::vector<std::int64_t> times = Sizes(elaborator, arguments[1], arguments.Place(1));
  if (times.size() < tensor.shape.size()) {
    Fail("shape", arguments.Place(1),
         "a tensor " + ShapeText(tensor.shape) + " wants a number of repeats for each dimension");
  }
  while (tensor.shape.size() < times.size()) tensor = math.Unsqueeze(tensor, 0);
  for (std::size_t d = 0; d < times.size(); ++d) {
    if (times[d] == 1) continue;
    if (times[d] == TensorMath::kKnownBatch && tensor.shape[d] == 1) {
      Shape shape = tensor.shape;
      shape[d] = kBatch;
      tensor = math.Expand(tensor, shape, arguments.position);
    } else if (times[d] >= 1 && times[d] <= elaborator.options().max_lanes &&
               !RunsOverEnvironments(tensor.shape[d])) {
      const std::vector<Tensor> copies(static_cast<std::size_t>(times[d]), tensor);
      tensor = math.Concatenate(copies, static_cast<int>(d), arguments.position);
    } else {
      Fail("shape", arguments.Place(1),
           "dimension " + std::to_string(d) + " of " + ShapeText(tensor.shape) +
               " cannot be repeated like this: the environments stay as many as they are");
    }
  }
  return TensorValue(math.Copy(tensor, arguments.position));
}

Value Flip(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<Value> given = *arguments[1].items;
  if (given.size() == 1 && (given[0].Is(ValueKind::kTuple) || given[0].Is(ValueKind::kList))) {
    given = elaborator.Items(given[0], arguments.Place(1));
  }
  for (const Value& one : given) {
    if (!one.Is(ValueKind::kInteger)) {
      Fail("arguments", arguments.Place(1), "a dimension is a whole number");
    }
    const int dimension = math.Dimension(one.integer, tensor.shape.size(), arguments.Place(1));
    if (IsSelected(tensor.shape[dimension])) {
      Fail("index", arguments.position, "what a mask picks has no order here");
    }
    if (tensor.shape[dimension] == kBatch) {
      tensor = math.Map(ScalarOperation::kBatchFlip, tensor, tensor.type, arguments.position);
      continue;
    }
    std::vector<Tensor> parts;
    for (int i = tensor.shape[dimension]; i-- > 0;) {
      parts.push_back(
          math.Unsqueeze(math.Take(tensor, dimension, i, arguments.position), dimension));
    }
    if (!parts.empty()) tensor = math.Concatenate(parts, dimension, arguments.position);
  }
  return TensorValue(math.Copy(tensor, arguments.position));
}

// Implements torch.unbind, torch.split and torch.chunk, by the size of the pieces.
Value Pieces(Elaborator& elaborator, const Tensor& tensor, int dimension, std::int64_t size,
             bool drop, Position position) {
  if (RunsOverEnvironments(tensor.shape[dimension])) {
    Fail("shape", position, "the environments cannot be parted; name another dimension with dim=");
  }
  std::vector<Value> pieces;
  const std::int64_t total = tensor.shape[dimension];
  for (std::int64_t start = 0; start < total; start += size) {
    const std::int64_t stop = std::min(total, start + size);
    pieces.push_back(TensorValue(drop
                                     ? elaborator.math().Take(tensor, dimension, start, position)
                                     : elaborator.math().Slice(tensor, dimension, start, stop, 1)));
  }
  return TupleValue(std::move(pieces));
}

Value Unbind(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const int dimension = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1),
                                                    tensor.shape.size(), arguments.Place(1));
  return Pieces(elaborator, tensor, dimension, 1, true, arguments.position);
}

Value Split(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const int dimension = elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 2),
                                                    tensor.shape.size(), arguments.Place(2));
  std::int64_t size = IntegerArgument(elaborator, arguments, 1);
  if (size < 1) Fail("arguments", arguments.Place(1), "the pieces have to be at least 1 wide");
  if (arguments.function->variant == 1 && !RunsOverEnvironments(tensor.shape[dimension])) {
    size = std::max<std::int64_t>(1, (tensor.shape[dimension] + size - 1) / size);
  }
  return Pieces(elaborator, tensor, dimension, size, false, arguments.position);
}

Value Size(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<Value> sizes;
  for (const int size : tensor.shape) sizes.push_back(elaborator.SizeValue(size));
  if (arguments[1].Is(ValueKind::kNone)) return TupleValue(std::move(sizes));
  return sizes[elaborator.math().Dimension(IntegerArgument(elaborator, arguments, 1), sizes.size(),
                                           arguments.Place(1))];
}

Value Rank(Elaborator& elaborator, const Arguments& arguments) {
  return IntegerValue(
      static_cast<std::int64_t>(TensorArgument(elaborator, arguments, 0).shape.size()));
}

Value ElementCount(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::int64_t lanes = LaneCount(tensor.shape);
  const auto over = std::find_if(tensor.shape.begin(), tensor.shape.end(), RunsOverEnvironments);
  if (over == tensor.shape.end()) return IntegerValue(lanes);
  const Value rows = elaborator.SizeValue(*over);
  if (lanes == 1) return rows;
  return elaborator.Binary(Operator::kMultiply, IntegerValue(lanes), rows, arguments.position);
}

constexpr ScalarOperation kNoShapeOperation = ScalarOperation::kConstant;

constexpr LibraryFunction kShapeFunctions[] = {
    {"torch.stack np.stack", "tensors dim=0", Stack},
    {"torch.cat torch.concat torch.concatenate np.concatenate", "tensors dim=0", Concatenate},
    {"torch.unsqueeze Tensor.unsqueeze np.expand_dims", "input dim", Unsqueeze},
    {"torch.squeeze Tensor.squeeze np.squeeze", "input dim=None", Squeeze},
    {"torch.transpose Tensor.transpose torch.swapaxes Tensor.swapaxes", "input dim0 dim1",
     Transpose},
    {"torch.permute Tensor.permute np.transpose", "input *dims", Permute},
    {"torch.reshape Tensor.reshape Tensor.view np.reshape", "input *shape", Reshape},
    {"Tensor.view_as Tensor.reshape_as", "input other", ReshapeAs},
    {"torch.t Tensor.t", "input", SwapTwo},
    {"torch.vstack np.vstack", "tensors", Rows},
    {"torch.hstack np.hstack", "tensors", ShapeColumns},
    {"torch.flatten Tensor.flatten Tensor.ravel np.ravel", "input start_dim=0 end_dim=-1", Flatten},
    {"Tensor.expand torch.broadcast_to np.broadcast_to", "input *size", Expand},
    {"Tensor.expand_as", "input other", ExpandAs},
    {"Tensor.repeat torch.tile np.tile", "input *repeats", Repeat},
    {"torch.flip Tensor.flip np.flip", "input *dims", Flip},
    {"torch.unbind Tensor.unbind", "input dim=0", Unbind},
    {"torch.split Tensor.split", "input split_size dim=0", Split, kNoShapeOperation, 0},
    {"torch.chunk Tensor.chunk", "input chunks dim=0", Split, kNoShapeOperation, 1},
    {"Tensor.size", "input dim=None", Size},
    {"Tensor.dim Tensor.ndimension", "input", Rank},
    {"torch.numel Tensor.numel Tensor.nelement", "input", ElementCount},
};

}  // namespace

LibraryPart ShapeFunctions() {
  return {kShapeFunctions, std::size(kShapeFunctions)};
}

}  // namespace simwright::reward
