#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

void WantFloats(const Arguments& arguments, const Tensor& tensor) {
  // Numpy converts integers to floats by itself.
  if (tensor.type == DataType::kFloat || arguments.called.starts_with("np.")) return;
  Fail("type", arguments.position,
       "'" + arguments.called + "' wants floats, this is " + Describe(TensorValue(tensor)) +
           "; .float() it first");
}

// Returns the dimensions of a reduction. "dim=-1" is meant for the numbers of one environment.
std::vector<int> Reduced(Elaborator& elaborator, const Arguments& arguments, std::size_t i,
                         const Tensor& tensor) {
  const std::vector<int> dimensions = Dimensions(elaborator, arguments, i, tensor);
  const bool last = arguments[i].Is(ValueKind::kInteger) && arguments[i].integer == -1;
  if (last && dimensions.size() == 1 && tensor.shape[dimensions[0]] == kBatch) {
    const bool norm = arguments.called.ends_with("norm");
    elaborator.ReportCollapse(norm ? "norm-over-environments" : "reduction-over-environments",
                              tensor.shape, arguments.position);
  }
  return dimensions;
}

Value Simple(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  const auto reduction = static_cast<Reduction>(arguments.function->variant);
  return TensorValue(elaborator.math().Reduce(reduction, tensor, dimensions,
                                              FlagArgument(arguments, 2), arguments.position));
}

Value Mean(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  WantFloats(arguments, tensor);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  return TensorValue(
      elaborator.math().Mean(tensor, dimensions, FlagArgument(arguments, 2), arguments.position));
}

// Returns the standard deviation or variance (variant 1); torch divides by n - 1, numpy by n.
Value Deviation(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  WantFloats(arguments, tensor);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  const Tensor mean = math.Mean(tensor, dimensions, true, position);
  const Tensor gap = math.Map(kSubtract, tensor, mean, DataType::kFloat, position);
  const Tensor squares = math.Map(kMultiply, gap, gap, DataType::kFloat, position);
  const Tensor sum =
      math.Reduce(Reduction::kSum, squares, dimensions, FlagArgument(arguments, 2), position);
  const bool unbiased = FlagArgument(arguments, 3) && !arguments.called.starts_with("np.");
  NodeId count = math.CountOver(tensor, dimensions);
  if (unbiased) count = math.graph().Apply(kSubtract, count, math.graph().Constant(1.0));
  const Tensor variance =
      math.Map(kDivide, sum, math.Scalar(DataType::kFloat, count), DataType::kFloat, position);
  if (arguments.function->variant == 1) return TensorValue(variance);
  return TensorValue(math.Map(kSquareRoot, variance, DataType::kFloat, position));
}

double Order(Elaborator& elaborator, const Arguments& arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (value.Is(ValueKind::kNone)) return 2.0;
  if (value.Is(ValueKind::kString)) {
    if (value.text == "fro") return 2.0;
    if (value.text == "inf") return std::numeric_limits<double>::infinity();
    Fail("arguments", arguments.Place(i), "the norm '" + value.text + "' is not offered");
  }
  return NumberArgument(elaborator, arguments, i);
}

Value Norm(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  WantFloats(arguments, tensor);
  const double p = Order(elaborator, arguments, 1);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 2, tensor);
  const bool keep = FlagArgument(arguments, 3);
  if (std::any_of(dimensions.begin(), dimensions.end(),
                  [&](int dimension) { return RunsOverEnvironments(tensor.shape[dimension]); })) {
    elaborator.Report("norm-over-environments", core::Severity::kWarning, position,
                      "this is one length over all environments; name the dimension, dim=-1");
  }
  const auto number = [&](double value) {
    return math.Scalar(DataType::kFloat, math.graph().Constant(value));
  };
  const auto map = [&](ScalarOperation operation, const Tensor& a) {
    return math.Map(operation, a, DataType::kFloat, position);
  };
  if (p == 2.0) {
    const Tensor squares = math.Map(kMultiply, tensor, tensor, DataType::kFloat, position);
    return TensorValue(
        map(kSquareRoot, math.Reduce(Reduction::kSum, squares, dimensions, keep, position)));
  }
  const Tensor sizes = map(kAbsolute, tensor);
  if (std::isinf(p)) {
    const Reduction reduction = p > 0 ? Reduction::kMaximum : Reduction::kMinimum;
    return TensorValue(math.Reduce(reduction, sizes, dimensions, keep, position));
  }
  if (p == 0.0) {
    const Tensor some = math.Map(kNotEqual, tensor, number(0.0), DataType::kFloat, position);
    return TensorValue(math.Reduce(Reduction::kSum, some, dimensions, keep, position));
  }
  const Tensor powers = math.Map(kPower, sizes, number(p), DataType::kFloat, position);
  const Tensor sum = math.Reduce(Reduction::kSum, powers, dimensions, keep, position);
  return TensorValue(math.Map(kPower, sum, number(1.0 / p), DataType::kFloat, position));
}

// Returns the index of the first maximum (or minimum) along a dimension.
Tensor PlaceOfExtreme(Elaborator& elaborator, const Tensor& tensor, int dimension, bool largest,
                      Position position) {
  TensorMath& math = elaborator.math();
  Tensor best = math.Take(tensor, dimension, 0, position);
  Tensor place = math.Full(DataType::kInteger, best.shape, math.graph().Constant(0.0), position);
  for (int i = 1; i < tensor.shape[dimension]; ++i) {
    const Tensor other = math.Take(tensor, dimension, i, position);
    const Tensor better = largest ? math.Map(kLess, best, other, DataType::kBool, position)
                                  : math.Map(kLess, other, best, DataType::kBool, position);
    best = math.Select(better, other, best, position);
    place = math.Select(better, math.Scalar(DataType::kInteger, math.graph().Constant(i)), place,
                        position);
  }
  return place;
}

// Returns the index as a value where it is usable: an index among the environments is not
// supported.
Value PlaceValue(Elaborator& elaborator, const Tensor& tensor, int dimension, bool keep,
                 bool largest, Position position) {
  if (RunsOverEnvironments(tensor.shape[dimension])) {
    return PlainValue(ValueKind::kUndefined,
                      "which environment is the best one is not offered; name another dimension "
                      "with dim=");
  }
  Tensor place = PlaceOfExtreme(elaborator, tensor, dimension, largest, position);
  if (keep) place = elaborator.math().Unsqueeze(place, dimension);
  return TensorValue(std::move(place));
}

// Implements torch.max(x), torch.max(x, dim), torch.max(x, y), and the builtin for numbers
// (python_functions.cpp).
Value ReductionExtreme(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const bool largest = arguments.function->variant == 1;
  const Position position = arguments.position;
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Reduction reduction = largest ? Reduction::kMaximum : Reduction::kMinimum;
  const Value& second = arguments[1];
  const bool numpy = arguments.called.starts_with("np.");
  if (second.Is(ValueKind::kTensor)) {
    const Tensor& other = *second.tensor;
    return TensorValue(math.Map(largest ? kMaximum : kMinimum, tensor, other,
                                Promote(tensor.type, other.type), position));
  }
  if (second.Is(ValueKind::kFloat)) {
    Fail("arguments", arguments.Place(1),
         "'" + arguments.called + "' compares tensors, this is a number; use torch.clamp(x, " +
             (largest ? "min=" : "max=") + "...)");
  }
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  const bool keep = FlagArgument(arguments, 2);
  Value values = TensorValue(math.Reduce(reduction, tensor, dimensions, keep, position));
  if (second.Is(ValueKind::kNone) || numpy || dimensions.size() != 1) return values;
  return NamedTuple(
      {std::move(values), PlaceValue(elaborator, tensor, dimensions[0], keep, largest, position)},
      {"values", "indices"});
}

Value PlaceOf(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  if (dimensions.size() != 1) {
    Fail("arguments", arguments.position,
         "'" + arguments.called + "' wants the dimension to look along, dim=-1");
  }
  return PlaceValue(elaborator, tensor, dimensions[0], FlagArgument(arguments, 2),
                    arguments.function->variant == 1, arguments.position);
}

Value CountNonzero(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor flags =
      math.Cast(TensorArgument(elaborator, arguments, 0), DataType::kBool, arguments.position);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, flags);
  return TensorValue(math.Reduce(Reduction::kSum, flags, dimensions, false, arguments.position));
}

// Returns e^x over its sum along a dimension, with the maximum subtracted first.
Value Softmax(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor tensor = FloatArgument(elaborator, arguments, 0);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  const Tensor most = math.Reduce(Reduction::kMaximum, tensor, dimensions, true, position);
  const Tensor power =
      math.Map(kExponential, math.Map(kSubtract, tensor, most, DataType::kFloat, position),
               DataType::kFloat, position);
  const Tensor sum = math.Reduce(Reduction::kSum, power, dimensions, true, position);
  return TensorValue(math.Map(kDivide, power, sum, DataType::kFloat, position));
}

// Returns the log of the sum of e^x along dimensions, with the maximum subtracted first.
Value LogSumExp(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const Tensor tensor = FloatArgument(elaborator, arguments, 0);
  const std::vector<int> dimensions = Reduced(elaborator, arguments, 1, tensor);
  const bool keep = FlagArgument(arguments, 2);
  const Tensor most = math.Reduce(Reduction::kMaximum, tensor, dimensions, true, position);
  const Tensor power =
      math.Map(kExponential, math.Map(kSubtract, tensor, most, DataType::kFloat, position),
               DataType::kFloat, position);
  const Tensor sum = math.Reduce(Reduction::kSum, power, dimensions, keep, position);
  const Tensor added = math.Reduce(Reduction::kMaximum, tensor, dimensions, keep, position);
  return TensorValue(math.Map(kAdd, math.Map(kLogarithm, sum, DataType::kFloat, position), added,
                              DataType::kFloat, position));
}

constexpr int ReductionVariant(Reduction reduction) {
  return static_cast<int>(reduction);
}

constexpr LibraryFunction kReductionFunctions[] = {
    {"torch.sum Tensor.sum np.sum", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kSum)},
    {"torch.prod Tensor.prod np.prod", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kProduct)},
    {"torch.amin Tensor.amin np.amin", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kMinimum)},
    {"torch.amax Tensor.amax np.amax", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kMaximum)},
    {"torch.all Tensor.all np.all", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kAll)},
    {"torch.any Tensor.any np.any", "input dim=None keepdim=False", Simple, kConstant,
     ReductionVariant(Reduction::kAny)},
    {"torch.mean Tensor.mean np.mean np.average", "input dim=None keepdim=False", Mean},
    {"torch.std Tensor.std np.std", "input dim=None keepdim=False unbiased=True", Deviation},
    {"torch.var Tensor.var np.var", "input dim=None keepdim=False unbiased=True", Deviation,
     kConstant, 1},
    {"torch.norm Tensor.norm torch.linalg.norm torch.linalg.vector_norm",
     "input p=2 dim=None keepdim=False", Norm},
    {"np.linalg.norm", "input p=2 dim=None keepdim=False", Norm},
    {"torch.min Tensor.min np.min", "input dim=None keepdim=False", ReductionExtreme, kConstant, 0},
    {"torch.max Tensor.max np.max", "input dim=None keepdim=False", ReductionExtreme, kConstant, 1},
    {"torch.argmin Tensor.argmin np.argmin", "input dim=None keepdim=False", PlaceOf, kConstant, 0},
    {"torch.argmax Tensor.argmax np.argmax", "input dim=None keepdim=False", PlaceOf, kConstant, 1},
    {"torch.count_nonzero np.count_nonzero", "input dim=None", CountNonzero},
    {"torch.logsumexp Tensor.logsumexp", "input dim keepdim=False", LogSumExp},
    {"torch.softmax Tensor.softmax torch.nn.functional.softmax", "input dim", Softmax},
};

}  // namespace

LibraryPart ReductionFunctions() {
  return {kReductionFunctions, std::size(kReductionFunctions)};
}

}  // namespace simwright::reward
