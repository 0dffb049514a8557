// Losses and distances between two tensors.
#include <numeric>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

enum Loss { kSquaredError, kAbsoluteError, kHuber, kSmoothAbsolute };

// Returns the smooth L1 or Huber loss of the magnitudes |a - b|: quadratic below `delta` and linear
// above it. The Huber loss is delta times the smooth one.
Tensor Bent(TensorMath& math, const Tensor& size, double delta, bool huber, Position position) {
  const auto number = [&](double value) {
    return math.Scalar(DataType::kFloat, math.graph().Constant(value));
  };
  const auto times = [&](const Tensor& tensor, double factor) {
    return math.Map(kMultiply, tensor, number(factor), DataType::kFloat, position);
  };
  const Tensor squares = math.Map(kMultiply, size, size, DataType::kFloat, position);
  const Tensor line = math.Map(kSubtract, size, number(0.5 * delta), DataType::kFloat, position);
  const Tensor inside = math.Map(kLess, size, number(delta), DataType::kBool, position);
  return math.Select(inside, times(squares, huber ? 0.5 : 0.5 / delta),
                     huber ? times(line, delta) : line, position);
}

// Returns the mean over all elements, unless `reduction` is "sum" or "none".
Value LossOf(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Position position = arguments.position;
  const int loss = arguments.function->variant;
  const Tensor gap = math.Map(kSubtract, FloatArgument(elaborator, arguments, 0),
                              FloatArgument(elaborator, arguments, 1), DataType::kFloat, position);
  const Tensor size = math.Map(kAbsolute, gap, DataType::kFloat, position);
  Tensor each = size;
  if (loss == kSquaredError) each = math.Map(kMultiply, gap, gap, DataType::kFloat, position);
  if (loss == kHuber || loss == kSmoothAbsolute) {
    const double delta = NumberArgument(elaborator, arguments, 3);
    if (!(delta > 0.0)) Fail("arguments", arguments.Place(3), "this has to be above 0");
    each = Bent(math, size, delta, loss == kHuber, position);
  }
  const std::string reduction = arguments[2].Is(ValueKind::kString) ? arguments[2].text : "mean";
  if (reduction == "none") return TensorValue(each);
  std::vector<int> all(each.shape.size());
  std::iota(all.begin(), all.end(), 0);
  if (reduction == "sum")
    return TensorValue(math.Reduce(Reduction::kSum, each, all, false, position));
  if (reduction == "mean") return TensorValue(math.Mean(each, all, false, position));
  Fail("arguments", arguments.Place(2), "the reduction is 'none', 'mean' or 'sum'");
}

// Returns the norm of a - b over all elements.
Value Distance(Elaborator& elaborator, const Arguments& arguments) {
  Arguments norm = arguments;
  norm.function = FindLibraryFunction("torch.norm");
  norm.values = {
      elaborator.Binary(Operator::kSubtract, arguments[0], arguments[1], arguments.position),
      arguments[2], Value{}, BoolValue(false)};
  norm.places.assign(4, arguments.position);
  norm.given.assign(4, true);
  return norm.function->handler(elaborator, norm);
}

constexpr LibraryFunction kLossFunctions[] = {
    {"torch.nn.functional.mse_loss", "input target reduction=None", LossOf, kConstant,
     kSquaredError},
    {"torch.nn.functional.l1_loss", "input target reduction=None", LossOf, kConstant,
     kAbsoluteError},
    {"torch.nn.functional.huber_loss", "input target reduction=None delta=1.0", LossOf, kConstant,
     kHuber},
    {"torch.nn.functional.smooth_l1_loss", "input target reduction=None beta=1.0", LossOf,
     kConstant, kSmoothAbsolute},
    {"torch.dist Tensor.dist", "input other p=2", Distance},
};

}  // namespace

LibraryPart LossFunctions() {
  return {kLossFunctions, std::size(kLossFunctions)};
}

}  // namespace simwright::reward
