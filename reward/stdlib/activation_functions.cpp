// Activation functions, which rewards use to shape a number, and nan_to_num.
#include <cmath>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

enum Activation {
  kRelu,
  kLeakyRelu,
  kElu,
  kSoftplus,
  kSilu,
  kLogSigmoid,
  kHardTanh,
  kRelu6,
  kSoftsign,
};

// Float arithmetic on a tensor and numbers for one call.
class Shaper {
 public:
  Shaper(Elaborator& elaborator, const Arguments& arguments)
      : elaborator_(elaborator), arguments_(arguments), math_(elaborator.math()) {}

  Tensor Number(double value) {
    return math_.Scalar(DataType::kFloat, math_.graph().Constant(value));
  }
  Tensor Parameter(std::size_t i) { return Number(NumberArgument(elaborator_, arguments_, i)); }
  Tensor Do(ScalarOperation operation, const Tensor& a) {
    return math_.Map(operation, a, DataType::kFloat, arguments_.position);
  }
  Tensor Do(ScalarOperation operation, const Tensor& a, const Tensor& b) {
    return math_.Map(operation, a, b, DataType::kFloat, arguments_.position);
  }
  // Returns max(x, 0) + log(1 + e^-|x|), which does not overflow.
  Tensor Softplus(const Tensor& x) {
    return Do(kAdd, Do(kMaximum, x, Number(0.0)),
              Do(kLogarithmOfOnePlus, Do(kExponential, Do(kNegate, Do(kAbsolute, x)))));
  }
  Tensor Clamp(const Tensor& x, const Tensor& low, const Tensor& high) {
    return Do(kMinimum, Do(kMaximum, x, low), high);
  }

 private:
  Elaborator& elaborator_;
  const Arguments& arguments_;
  TensorMath& math_;
};

Value Activate(Elaborator& elaborator, const Arguments& arguments) {
  Shaper shaper(elaborator, arguments);
  const Tensor x = FloatArgument(elaborator, arguments, 0);
  const Tensor zero = shaper.Number(0.0);
  switch (arguments.function->variant) {
    case kLeakyRelu:
      return TensorValue(
          shaper.Do(kAdd, shaper.Do(kMaximum, x, zero),
                    shaper.Do(kMultiply, shaper.Do(kMinimum, x, zero), shaper.Parameter(1))));
    case kElu: {
      const Tensor below = shaper.Do(kExponentialMinusOne, shaper.Do(kMinimum, x, zero));
      return TensorValue(shaper.Do(kAdd, shaper.Do(kMaximum, x, zero),
                                   shaper.Do(kMultiply, below, shaper.Parameter(1))));
    }
    case kSoftplus: {
      const Tensor beta = shaper.Parameter(1);
      return TensorValue(shaper.Do(kDivide, shaper.Softplus(shaper.Do(kMultiply, x, beta)), beta));
    }
    case kSilu:
      return TensorValue(shaper.Do(kMultiply, x, shaper.Do(kSigmoid, x)));
    case kLogSigmoid:
      return TensorValue(shaper.Do(kNegate, shaper.Softplus(shaper.Do(kNegate, x))));
    case kHardTanh:
      return TensorValue(shaper.Clamp(x, shaper.Parameter(1), shaper.Parameter(2)));
    case kRelu6:
      return TensorValue(shaper.Clamp(x, zero, shaper.Number(6.0)));
    default:  // kSoftsign
      return TensorValue(
          shaper.Do(kDivide, x, shaper.Do(kAdd, shaper.Number(1.0), shaper.Do(kAbsolute, x))));
  }
}

// Integers stay integers.
Value Relu(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const Tensor x = TensorArgument(elaborator, arguments, 0);
  const Tensor zero = math.Scalar(x.type, math.graph().Constant(0.0));
  return TensorValue(math.Map(kMaximum, x, zero, x.type, arguments.position));
}

// Replaces NaN and the infinities by the given numbers, or by 0 and the largest floats.
Value NanToNumber(Elaborator& elaborator, const Arguments& arguments) {
  constexpr double kLargest = 3.4028234663852886e38;
  TensorMath& math = elaborator.math();
  Shaper shaper(elaborator, arguments);
  const Tensor x = FloatArgument(elaborator, arguments, 0);
  const auto replace = [&](const Tensor& from, const Tensor& flag, std::size_t i, double usual) {
    const bool given = !arguments[i].Is(ValueKind::kNone);
    return math.Select(flag, given ? shaper.Parameter(i) : shaper.Number(usual), from,
                       arguments.position);
  };
  const auto equals = [&](double value) {
    return math.Map(kEqual, x, shaper.Number(value), DataType::kBool, arguments.position);
  };
  Tensor number = replace(x, math.Map(kIsNan, x, DataType::kBool, arguments.position), 1, 0.0);
  number = replace(number, equals(HUGE_VAL), 2, kLargest);
  return TensorValue(replace(number, equals(-HUGE_VAL), 3, -kLargest));
}

constexpr LibraryFunction kActivationFunctions[] = {
    {"torch.relu Tensor.relu torch.nn.functional.relu", "input", Relu, kConstant, kRelu},
    {"torch.nn.functional.leaky_relu", "input negative_slope=0.01", Activate, kConstant,
     kLeakyRelu},
    {"torch.nn.functional.elu", "input alpha=1.0", Activate, kConstant, kElu},
    {"torch.nn.functional.softplus", "input beta=1.0 threshold=20.0", Activate, kConstant,
     kSoftplus},
    {"torch.nn.functional.silu", "input", Activate, kConstant, kSilu},
    {"torch.nn.functional.logsigmoid", "input", Activate, kConstant, kLogSigmoid},
    {"torch.nn.functional.hardtanh", "input min_val=-1.0 max_val=1.0", Activate, kConstant,
     kHardTanh},
    {"torch.nn.functional.relu6", "input", Activate, kConstant, kRelu6},
    {"torch.nn.functional.softsign", "input", Activate, kConstant, kSoftsign},
    {"torch.nan_to_num Tensor.nan_to_num np.nan_to_num", "input nan=None posinf=None neginf=None",
     NanToNumber},
};

}  // namespace

LibraryPart ActivationFunctions() {
  return {kActivationFunctions, std::size(kActivationFunctions)};
}

}  // namespace simwright::reward
