// Functions that depend on the order of numbers along a dimension, or select among them.
#include <algorithm>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

// The number of comparisons in a sort is quadratic in the number of elements.
constexpr int kMostSorted = 64;

// A tensor cut along one dimension, which must not be that of the environments.
class Slices {
 public:
  Slices(Elaborator& elaborator, const Arguments& arguments, const Tensor& tensor,
         std::int64_t dimension, Position place)
      : math_(elaborator.math()), position_(arguments.position) {
    dimension_ = math_.Dimension(dimension, tensor.shape.size(), place);
    if (tensor.shape[dimension_] < 0) {
      Fail("shape", place,
           "'" + arguments.called +
               "' does not work over the environments; name another dimension with dim=");
    }
    for (int i = 0; i < tensor.shape[dimension_]; ++i) {
      parts_.push_back(math_.Take(tensor, dimension_, i, position_));
    }
  }

  std::vector<Tensor>& parts() { return parts_; }
  int size() const { return static_cast<int>(parts_.size()); }

  Tensor Joined() {
    std::vector<Tensor> parts;
    for (const Tensor& part : parts_) parts.push_back(math_.Unsqueeze(part, dimension_));
    if (parts.empty()) Fail("shape", position_, "there is nothing along this dimension");
    return math_.Concatenate(parts, dimension_, position_);
  }

  // Sorts by exchanges of neighbours, the smallest first.
  void Sort(bool descending) {
    if (size() > kMostSorted) {
      Fail("too-large", position_,
           "at most " + std::to_string(kMostSorted) + " numbers are sorted");
    }
    for (int end = size(); end > 1; --end) {
      for (int i = 0; i + 1 < end; ++i) {
        const Tensor a = parts_[i], b = parts_[i + 1];
        const Tensor low = math_.Map(kMinimum, a, b, a.type, position_);
        const Tensor high = math_.Map(kMaximum, a, b, a.type, position_);
        parts_[i] = descending ? high : low;
        parts_[i + 1] = descending ? low : high;
      }
    }
  }

 private:
  TensorMath& math_;
  Position position_;
  int dimension_ = 0;
  std::vector<Tensor> parts_;
};

Value NoPlaces() {
  return PlainValue(ValueKind::kUndefined,
                    "where sorted numbers came from is not offered; .values are");
}

Value Sort(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  Slices slices(elaborator, arguments, tensor, IntegerArgument(elaborator, arguments, 1),
                arguments.Place(1));
  slices.Sort(FlagArgument(arguments, 2));
  Value values = TensorValue(slices.Joined());
  if (arguments.called.starts_with("np.")) return values;
  return NamedTuple({std::move(values), NoPlaces()}, {"values", "indices"});
}

Value TopK(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::int64_t count = IntegerArgument(elaborator, arguments, 1);
  Slices slices(elaborator, arguments, tensor, IntegerArgument(elaborator, arguments, 2),
                arguments.Place(2));
  if (count < 1 || count > slices.size()) {
    Fail("arguments", arguments.Place(1),
         std::to_string(count) + " cannot be taken of " + std::to_string(slices.size()));
  }
  slices.Sort(FlagArgument(arguments, 3));
  slices.parts().resize(static_cast<std::size_t>(count));
  return NamedTuple({TensorValue(slices.Joined()), NoPlaces()}, {"values", "indices"});
}

// Returns the median: torch's is the lower of the two in the middle, numpy's their mean.
Value Median(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const bool numpy = arguments.called.starts_with("np.");
  std::int64_t dimension = -1;
  if (arguments.given[1]) {
    dimension = IntegerArgument(elaborator, arguments, 1);
  } else if (BatchDimension(tensor.shape) >= 0) {
    Fail("unsupported", arguments.position,
         "a median over all environments is not offered; name another dimension with dim=");
  } else if (tensor.shape.size() != 1) {
    tensor = math.Reshape(tensor, {-1}, arguments.position);
  }
  Slices slices(elaborator, arguments, tensor, dimension, arguments.Place(1));
  slices.Sort(false);
  if (slices.size() == 0) Fail("shape", arguments.position, "there is nothing to choose from");
  Tensor middle = slices.parts()[static_cast<std::size_t>((slices.size() - 1) / 2)];
  if (numpy && slices.size() % 2 == 0) {
    const Tensor upper = slices.parts()[static_cast<std::size_t>(slices.size() / 2)];
    const Tensor half = math.Scalar(DataType::kFloat, math.graph().Constant(0.5));
    middle = math.Map(kMultiply, math.Map(kAdd, middle, upper, upper.type, arguments.position),
                      half, DataType::kFloat, arguments.position);
  }
  if (numpy || !arguments.given[1]) return TensorValue(std::move(middle));
  return NamedTuple({TensorValue(std::move(middle)), NoPlaces()}, {"values", "indices"});
}

// Returns cumulative sums (products: variant 1).
Value Cumulated(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  if (tensor.type == DataType::kBool) {
    tensor = math.Cast(tensor, DataType::kInteger, arguments.position);
  }
  Slices slices(elaborator, arguments, tensor, IntegerArgument(elaborator, arguments, 1),
                arguments.Place(1));
  for (int i = 1; i < slices.size(); ++i) {
    slices.parts()[i] =
        math.Map(arguments.function->variant == 1 ? kMultiply : kAdd, slices.parts()[i - 1],
                 slices.parts()[i], tensor.type, arguments.position);
  }
  return TensorValue(slices.Joined());
}

Value Roll(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::int64_t shift = IntegerArgument(elaborator, arguments, 1);
  Value dimension = arguments[2];
  if (dimension.Is(ValueKind::kTuple) && dimension.items->size() == 1) {
    dimension = dimension.items->front();
  }
  if (!dimension.Is(ValueKind::kInteger)) {
    Fail("arguments", arguments.Place(2),
         "'" + arguments.called + "' wants one dimension, dims=-1");
  }
  Slices slices(elaborator, arguments, tensor, dimension.integer, arguments.Place(2));
  const std::int64_t size = std::max(1, slices.size());
  std::rotate(slices.parts().begin(),
              slices.parts().begin() + static_cast<std::ptrdiff_t>(((-shift) % size + size) % size),
              slices.parts().end());
  return TensorValue(slices.Joined());
}

// Returns the element of `slices` that each environment's index selects.
Tensor Chosen(TensorMath& math, const std::vector<Tensor>& slices, const Tensor& index,
              Position position) {
  Tensor chosen =
      math.Expand(slices[0], math.Broadcast(slices[0].shape, index.shape, position), position);
  for (std::size_t i = 1; i < slices.size(); ++i) {
    const Tensor number =
        math.Scalar(DataType::kInteger, math.graph().Constant(static_cast<double>(i)));
    chosen = math.Select(math.Map(kEqual, index, number, DataType::kBool, position), slices[i],
                         chosen, position);
  }
  return chosen;
}

void WantWhole(const Tensor& index, const Arguments& arguments, std::size_t i) {
  if (index.type == DataType::kInteger) return;
  Fail("type", arguments.Place(i),
       "indices are whole numbers, this is " + Describe(arguments[i]) + "; use .long()");
}

// Implements input.gather(dim, index): the result has the shape of `index`.
Value Gather(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Tensor index = TensorArgument(elaborator, arguments, 2);
  WantWhole(index, arguments, 2);
  Slices slices(elaborator, arguments, tensor, IntegerArgument(elaborator, arguments, 1),
                arguments.Place(1));
  const int dimension = math.Dimension(arguments[1].integer, tensor.shape.size(), {});
  Shape wanted = tensor.shape;
  if (index.shape.size() == wanted.size()) wanted[dimension] = index.shape[dimension];
  if (index.shape != wanted || index.shape[dimension] < 0) {
    Fail("shape", arguments.Place(2),
         "an index " + ShapeText(index.shape) + " does not fit a tensor " +
             ShapeText(tensor.shape) + ": sizes beside the dimension have to be equal");
  }
  std::vector<Tensor> parts;
  for (int i = 0; i < index.shape[dimension]; ++i) {
    const Tensor one = math.Take(index, dimension, i, arguments.position);
    parts.push_back(
        math.Unsqueeze(Chosen(math, slices.parts(), one, arguments.position), dimension));
  }
  if (parts.empty()) Fail("shape", arguments.Place(2), "the index is empty");
  return TensorValue(math.Concatenate(parts, dimension, arguments.position));
}

// Implements input.index_select(dim, index) for constant indices.
Value IndexSelect(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Tensor index = TensorArgument(elaborator, arguments, 2);
  WantWhole(index, arguments, 2);
  const int dimension = math.Dimension(IntegerArgument(elaborator, arguments, 1),
                                       tensor.shape.size(), arguments.Place(1));
  std::vector<Tensor> parts;
  for (std::size_t lane = 0; lane < index.lanes.size(); ++lane) {
    float known = 0.0f;
    if (!math.graph().IsConstant(math.At(index, lane), &known)) {
      Fail("index", arguments.Place(2),
           "these indices differ between environments; use torch.gather");
    }
    parts.push_back(math.Unsqueeze(
        math.Take(tensor, dimension, static_cast<std::int64_t>(known), arguments.position),
        dimension));
  }
  if (parts.empty()) Fail("shape", arguments.Place(2), "the index is empty");
  return TensorValue(math.Concatenate(parts, dimension, arguments.position));
}

Value OneHot(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor index = TensorArgument(elaborator, arguments, 0);
  WantWhole(index, arguments, 0);
  const std::int64_t classes = IntegerArgument(elaborator, arguments, 1);
  if (classes < 1 || classes > elaborator.options().max_lanes) {
    Fail("arguments", arguments.Place(1),
         "the number of classes has to be given, since the largest index is not known before");
  }
  std::vector<NodeId> nodes;
  for (std::int64_t i = 0; i < classes; ++i) {
    nodes.push_back(math.graph().Constant(static_cast<double>(i)));
  }
  const Tensor numbers = math.Make(DataType::kInteger, {static_cast<int>(classes)},
                                   std::move(nodes), arguments.position);
  const Tensor column = math.Unsqueeze(index, static_cast<int>(index.shape.size()));
  return TensorValue(math.Map(kEqual, column, numbers, DataType::kInteger, arguments.position));
}

Value MaskedFill(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Tensor mask = TensorArgument(elaborator, arguments, 1);
  const Tensor value = NumberOrTensor(elaborator, arguments, 2);
  if (mask.type != DataType::kBool || !value.shape.empty()) {
    Fail("type", arguments.Place(1), "'" + arguments.called + "' wants flags and one number");
  }
  const Tensor filled = math.Select(mask, math.Cast(value, tensor.type, arguments.Place(2)), tensor,
                                    arguments.position);
  return TensorValue(filled);
}

constexpr LibraryFunction kOrderFunctions[] = {
    {"torch.sort Tensor.sort np.sort", "input dim=-1 descending=False", Sort},
    {"torch.topk Tensor.topk", "input k dim=-1 largest=True sorted=True", TopK},
    {"torch.median Tensor.median np.median", "input dim=None", Median},
    {"torch.cumsum Tensor.cumsum np.cumsum", "input dim", Cumulated, kConstant, 0},
    {"torch.cumprod Tensor.cumprod np.cumprod", "input dim", Cumulated, kConstant, 1},
    {"torch.roll Tensor.roll np.roll", "input shifts dims=None", Roll},
    {"torch.gather Tensor.gather", "input dim index", Gather},
    {"torch.index_select Tensor.index_select", "input dim index", IndexSelect},
    {"torch.nn.functional.one_hot", "tensor num_classes=-1", OneHot},
    {"torch.masked_fill Tensor.masked_fill", "input mask value", MaskedFill},
};

}  // namespace

LibraryPart OrderFunctions() {
  return {kOrderFunctions, std::size(kOrderFunctions)};
}

}  // namespace simwright::reward
