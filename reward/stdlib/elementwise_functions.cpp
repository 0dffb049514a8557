#include <cmath>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

// The result type of a function of integers and flags.
enum ElementwiseVariant { kMakesFloat, kKeepsType, kMakesFlag };

// Rejects a tensor for functions such as math.sqrt, which take one number.
void RefuseBatch(const Arguments& arguments, const Tensor& tensor) {
  if (!arguments.called.starts_with("math.") || tensor.shape.empty()) return;
  Fail("type", arguments.Place(0),
       "'" + arguments.called + "' takes one number, this is a tensor " + ShapeText(tensor.shape) +
           "; use torch." + arguments.called.substr(5));
}

double OnNumber(ScalarOperation operation, double x) {
  switch (operation) {
    case kNegate:
      return -x;
    case kAbsolute:
      return std::fabs(x);
    case kSquareRoot:
      return std::sqrt(x);
    case kExponential:
      return std::exp(x);
    case kLogarithm:
      return std::log(x);
    case kSine:
      return std::sin(x);
    case kCosine:
      return std::cos(x);
    case kTangent:
      return std::tan(x);
    case kArcSine:
      return std::asin(x);
    case kArcCosine:
      return std::acos(x);
    case kArcTangent:
      return std::atan(x);
    case kHyperbolicTangent:
      return std::tanh(x);
    case kFloor:
      return std::floor(x);
    case kCeiling:
      return std::ceil(x);
    case kRound:
      return std::nearbyint(x);
    case kTruncate:
      return std::trunc(x);
    case kLogarithmOfOnePlus:
      return std::log1p(x);
    case kExponentialMinusOne:
      return std::expm1(x);
    case kSign:
      return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
    default:
      return 1.0 / (1.0 + std::exp(-x));  // the sigmoid
  }
}

Value Unary(Elaborator& elaborator, const Arguments& arguments) {
  const ScalarOperation operation = arguments.function->operation;
  const int variant = arguments.function->variant;
  const Value& value = arguments[0];
  if (value.IsNumber() && !WantsTensors(arguments) && variant != kMakesFlag) {
    const double result = OnNumber(operation, value.Number());
    const bool rounds = operation == kFloor || operation == kCeiling || operation == kTruncate;
    const bool whole = (variant == kKeepsType && !value.Is(ValueKind::kFloat)) ||
                       (rounds && arguments.called.starts_with("math."));
    if (whole && std::fabs(result) < 9e18) return IntegerValue(static_cast<std::int64_t>(result));
    return FloatValue(result);
  }
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  RefuseBatch(arguments, tensor);
  TensorMath& math = elaborator.math();
  if (variant == kMakesFloat) tensor = math.Cast(tensor, DataType::kFloat, arguments.position);
  if (operation == kNegate && tensor.type == DataType::kBool) {
    Fail("type", arguments.position, "a flag cannot be negated; use torch.logical_not");
  }
  const DataType type = variant == kMakesFlag ? DataType::kBool : tensor.type;
  // Rounding leaves integers unchanged.
  const bool rounds = operation >= kFloor && operation <= kTruncate;
  if (rounds && tensor.type != DataType::kFloat) return TensorValue(tensor);
  return TensorValue(math.Map(operation, tensor, type, arguments.position));
}

Value LogicalNot(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  return TensorValue(elaborator.math().Map(kNot, tensor, DataType::kBool, arguments.position));
}

// Functions of one operand that are short formulas of others.
enum Formula {
  kSquare,
  kReciprocal,
  kPowerOfTwo,
  kRootReciprocal,
  kLogarithm2,
  kLogarithm10,
  kHyperbolicSine,
  kHyperbolicCosine,
  kRadians,
  kDegrees,
  kIsInfinite,
  kIsFinite,
};

class Formulas {
 public:
  Formulas(Elaborator& elaborator, Position position)
      : math_(elaborator.math()), position_(position) {}

  Tensor Number(double value) {
    return math_.Scalar(DataType::kFloat, math_.graph().Constant(value));
  }
  Tensor Do(ScalarOperation operation, const Tensor& a) {
    return math_.Map(operation, a, a.type, position_);
  }
  Tensor Do(ScalarOperation operation, const Tensor& a, const Tensor& b) {
    return math_.Map(operation, a, b, Promote(a.type, b.type), position_);
  }
  Tensor Of(int formula, const Tensor& x);

 private:
  Tensor HalfOf(ScalarOperation operation, const Tensor& x) {
    const Tensor up = Do(kExponential, x), down = Do(kExponential, Do(kNegate, x));
    return Do(kMultiply, Do(operation, up, down), Number(0.5));
  }
  Tensor Infinite(const Tensor& x) {
    return math_.Map(kEqual, Do(kAbsolute, x), Number(HUGE_VAL), DataType::kBool, position_);
  }

  TensorMath& math_;
  Position position_;
};

Tensor Formulas::Of(int formula, const Tensor& x) {
  switch (formula) {
    case kSquare:
      return Do(kMultiply, x, x);
    case kReciprocal:
      return Do(kDivide, Number(1.0), x);
    case kRootReciprocal:
      return Do(kDivide, Number(1.0), Do(kSquareRoot, x));
    case kPowerOfTwo:
      return Do(kPower, Number(2.0), x);
    case kLogarithm2:
      return Do(kMultiply, Do(kLogarithm, x), Number(1.44269504088896341));
    case kLogarithm10:
      return Do(kMultiply, Do(kLogarithm, x), Number(0.43429448190325183));
    case kHyperbolicSine:
      return HalfOf(kSubtract, x);
    case kHyperbolicCosine:
      return HalfOf(kAdd, x);
    case kRadians:
      return Do(kMultiply, x, Number(0.017453292519943295));
    case kDegrees:
      return Do(kMultiply, x, Number(57.295779513082321));
    case kIsInfinite:
      return Infinite(x);
    default: {  // kIsFinite
      const Tensor nan = math_.Map(kIsNan, x, DataType::kBool, position_);
      return Do(kNot, Do(kOr, nan, Infinite(x)));
    }
  }
}

Value ByFormula(Elaborator& elaborator, const Arguments& arguments) {
  const int formula = arguments.function->variant;
  const Value& value = arguments[0];
  const bool keeps = formula == kSquare;
  if (value.IsNumber() && !WantsTensors(arguments)) {
    const double x = value.Number();
    switch (formula) {
      case kSquare:
        return value.Is(ValueKind::kFloat)
                   ? FloatValue(x * x)
                   : elaborator.Binary(Operator::kMultiply, value, value, arguments.position);
      case kLogarithm2:
        return FloatValue(std::log2(x));
      case kLogarithm10:
        return FloatValue(std::log10(x));
      case kRadians:
        return FloatValue(x * 0.017453292519943295);
      case kDegrees:
        return FloatValue(x * 57.295779513082321);
      case kIsInfinite:
        return BoolValue(std::isinf(x));
      case kIsFinite:
        return BoolValue(std::isfinite(x));
      default:
        break;
    }
  }
  const Tensor tensor =
      keeps ? TensorArgument(elaborator, arguments, 0) : FloatArgument(elaborator, arguments, 0);
  RefuseBatch(arguments, tensor);
  return TensorValue(Formulas(elaborator, arguments.position).Of(formula, tensor));
}

// Implements torch.add and its siblings as operators, with torch's rejection of two plain numbers.
Value AsOperator(Elaborator& elaborator, const Arguments& arguments) {
  const auto operation = static_cast<Operator>(arguments.function->variant);
  if (WantsTensors(arguments) && arguments[0].IsNumber()) TensorArgument(elaborator, arguments, 0);
  Value other = arguments[1];
  if (arguments.values.size() > 2 && arguments.given[2]) {  // alpha
    other = elaborator.Binary(Operator::kMultiply, other, arguments[2], arguments.position);
  }
  Value left = arguments[0];
  for (Value* value : {&left, &other}) {
    if (value->Is(ValueKind::kList)) {
      *value = TensorValue(ArrayFrom(elaborator, *value, arguments.position));
    }
  }
  if (operation >= Operator::kLess && operation <= Operator::kNotEqual) {
    return elaborator.Compare(operation, left, other, arguments.position);
  }
  return elaborator.Binary(operation, left, other, arguments.position);
}

// Implements functions of two operands with torch's result type.
Value Pair(Elaborator& elaborator, const Arguments& arguments) {
  const ScalarOperation operation = arguments.function->operation;
  const int variant = arguments.function->variant;
  TensorMath& math = elaborator.math();
  const bool numbers = arguments[0].IsNumber() && arguments[1].IsNumber();
  if (numbers && !WantsTensors(arguments)) {
    const double x = arguments[0].Number(), y = arguments[1].Number();
    if (operation == kArcTangent2) return FloatValue(std::atan2(x, y));
    if (operation == kMinimum) return arguments[x <= y ? 0 : 1];
    if (operation == kMaximum) return arguments[x >= y ? 0 : 1];
    if (operation == kTruncatedRemainder && y != 0.0) return FloatValue(std::fmod(x, y));
  }
  Tensor a = TensorArgument(elaborator, arguments, 0);
  Tensor b = operation == kTruncatedRemainder ? NumberOrTensor(elaborator, arguments, 1)
                                              : TensorArgument(elaborator, arguments, 1);
  RefuseBatch(arguments, a);
  if (variant == kMakesFloat) {
    a = math.Cast(a, DataType::kFloat, arguments.position);
    b = math.Cast(b, DataType::kFloat, arguments.position);
  }
  const DataType type = variant == kMakesFlag ? DataType::kBool : Promote(a.type, b.type);
  if (variant == kMakesFlag) {
    a = math.Cast(a, DataType::kBool, arguments.position);
    b = math.Cast(b, DataType::kBool, arguments.position);
  }
  return TensorValue(math.Map(operation, a, b, type, arguments.position));
}

Value Hypotenuse(Elaborator& elaborator, const Arguments& arguments) {
  Formulas formulas(elaborator, arguments.position);
  const Tensor a = FloatArgument(elaborator, arguments, 0);
  const Tensor b = FloatArgument(elaborator, arguments, 1);
  return TensorValue(formulas.Do(
      kSquareRoot, formulas.Do(kAdd, formulas.Do(kMultiply, a, a), formulas.Do(kMultiply, b, b))));
}

Value Clamp(Elaborator& elaborator, const Arguments& arguments) {
  TensorMath& math = elaborator.math();
  const bool low = !arguments[1].Is(ValueKind::kNone), high = !arguments[2].Is(ValueKind::kNone);
  if (!low && !high) {
    Fail("arguments", arguments.position, "'" + arguments.called + "' wants min, max or both");
  }
  bool numbers = !WantsTensors(arguments);
  for (const Value& value : arguments.values) {
    numbers = numbers && (value.IsNumber() || value.Is(ValueKind::kNone));
  }
  if (numbers && arguments[0].IsNumber()) {
    Value value = arguments[0];
    if (low && value.Number() < arguments[1].Number()) value = arguments[1];
    if (high && value.Number() > arguments[2].Number()) value = arguments[2];
    return value;
  }
  Tensor tensor = TensorArgument(elaborator, arguments, 0);
  for (const std::size_t i : {1, 2}) {
    if (arguments[i].Is(ValueKind::kNone)) continue;
    const Tensor bound = NumberOrTensor(elaborator, arguments, i);
    const DataType type = Promote(tensor.type, bound.type);
    tensor = math.Map(i == 1 ? kMaximum : kMinimum, tensor, bound, type, arguments.position);
  }
  return TensorValue(tensor);
}

Value ClampMax(Elaborator& elaborator, const Arguments& arguments) {
  const Tensor tensor = TensorArgument(elaborator, arguments, 0);
  const Tensor bound = NumberOrTensor(elaborator, arguments, 1);
  return TensorValue(elaborator.math().Map(kMinimum, tensor, bound,
                                           Promote(tensor.type, bound.type), arguments.position));
}

Value Where(Elaborator& elaborator, const Arguments& arguments) {
  if (!arguments.given[1] || !arguments.given[2]) {
    Fail("arguments", arguments.position,
         "'" + arguments.called + "' wants a condition and two values: where(condition, a, b)");
  }
  Tensor condition = NumberOrTensor(elaborator, arguments, 0);
  if (condition.type != DataType::kBool) {
    if (!arguments.called.starts_with("np.")) {
      Fail("type", arguments.Place(0),
           "the condition of torch.where has to be true or false, this is " +
               Describe(arguments[0]) + "; compare it first");
    }
    condition = elaborator.math().Cast(condition, DataType::kBool, arguments.position);
  }
  const Tensor a = NumberOrTensor(elaborator, arguments, 1);
  const Tensor b = NumberOrTensor(elaborator, arguments, 2);
  return TensorValue(elaborator.math().Select(condition, a, b, arguments.position));
}

Value Lerp(Elaborator& elaborator, const Arguments& arguments) {
  const Position position = arguments.position;
  const Value span = elaborator.Binary(Operator::kSubtract, arguments[1], arguments[0], position);
  const Value way = elaborator.Binary(Operator::kMultiply, span, arguments[2], position);
  return elaborator.Binary(Operator::kAdd, arguments[0], way, position);
}

// Returns input + value * a * b.
Value AddProduct(Elaborator& elaborator, const Arguments& arguments) {
  const Position position = arguments.position;
  Value product = elaborator.Binary(Operator::kMultiply, arguments[1], arguments[2], position);
  product = elaborator.Binary(Operator::kMultiply, product, arguments[3], position);
  return elaborator.Binary(Operator::kAdd, arguments[0], product, position);
}

Value IsClose(Elaborator& elaborator, const Arguments& arguments) {
  Formulas formulas(elaborator, arguments.position);
  const Tensor a = FloatArgument(elaborator, arguments, 0);
  const Tensor b = FloatArgument(elaborator, arguments, 1);
  const Tensor gap = formulas.Do(kAbsolute, formulas.Do(kSubtract, a, b));
  const Tensor relative = formulas.Number(NumberArgument(elaborator, arguments, 2));
  const Tensor absolute = formulas.Number(NumberArgument(elaborator, arguments, 3));
  const Tensor room =
      formulas.Do(kAdd, absolute, formulas.Do(kMultiply, relative, formulas.Do(kAbsolute, b)));
  return TensorValue(
      elaborator.math().Map(kLessEqual, gap, room, DataType::kBool, arguments.position));
}

constexpr int As(Operator operation) {
  return static_cast<int>(operation);
}

constexpr LibraryFunction kElementwiseFunctions[] = {
    {"torch.abs torch.absolute Tensor.abs np.abs np.absolute abs math.fabs np.fabs", "input", Unary,
     kAbsolute, kKeepsType},
    {"torch.neg torch.negative Tensor.neg np.negative", "input", Unary, kNegate, kKeepsType},
    {"torch.sign Tensor.sign np.sign torch.sgn", "input", Unary, kSign, kKeepsType},
    {"torch.floor Tensor.floor np.floor math.floor", "input", Unary, kFloor, kKeepsType},
    {"torch.ceil Tensor.ceil np.ceil math.ceil", "input", Unary, kCeiling, kKeepsType},
    {"torch.round Tensor.round np.round np.rint", "input", Unary, kRound, kKeepsType},
    {"torch.trunc Tensor.trunc np.trunc math.trunc torch.fix", "input", Unary, kTruncate,
     kKeepsType},
    {"torch.sqrt Tensor.sqrt np.sqrt math.sqrt", "input", Unary, kSquareRoot, kMakesFloat},
    {"torch.exp Tensor.exp np.exp math.exp", "input", Unary, kExponential, kMakesFloat},
    {"torch.expm1 Tensor.expm1 np.expm1 math.expm1", "input", Unary, kExponentialMinusOne,
     kMakesFloat},
    {"torch.log Tensor.log np.log math.log", "input", Unary, kLogarithm, kMakesFloat},
    {"torch.log1p Tensor.log1p np.log1p math.log1p", "input", Unary, kLogarithmOfOnePlus,
     kMakesFloat},
    {"torch.sin Tensor.sin np.sin math.sin", "input", Unary, kSine, kMakesFloat},
    {"torch.cos Tensor.cos np.cos math.cos", "input", Unary, kCosine, kMakesFloat},
    {"torch.tan Tensor.tan np.tan math.tan", "input", Unary, kTangent, kMakesFloat},
    {"torch.asin torch.arcsin Tensor.asin Tensor.arcsin np.arcsin math.asin", "input", Unary,
     kArcSine, kMakesFloat},
    {"torch.acos torch.arccos Tensor.acos Tensor.arccos np.arccos math.acos", "input", Unary,
     kArcCosine, kMakesFloat},
    {"torch.atan torch.arctan Tensor.atan Tensor.arctan np.arctan math.atan", "input", Unary,
     kArcTangent, kMakesFloat},
    {"torch.tanh Tensor.tanh np.tanh math.tanh torch.nn.functional.tanh", "input", Unary,
     kHyperbolicTangent, kMakesFloat},
    {"torch.sigmoid Tensor.sigmoid torch.nn.functional.sigmoid torch.special.expit", "input", Unary,
     kSigmoid, kMakesFloat},
    {"torch.isnan Tensor.isnan np.isnan", "input", Unary, kIsNan, kMakesFlag},
    {"torch.logical_not Tensor.logical_not np.logical_not", "input", LogicalNot},
    {"torch.square Tensor.square np.square", "input", ByFormula, kConstant, kSquare},
    {"torch.reciprocal Tensor.reciprocal np.reciprocal", "input", ByFormula, kConstant,
     kReciprocal},
    {"torch.rsqrt Tensor.rsqrt", "input", ByFormula, kConstant, kRootReciprocal},
    {"torch.exp2 Tensor.exp2 np.exp2", "input", ByFormula, kConstant, kPowerOfTwo},
    {"torch.log2 Tensor.log2 np.log2 math.log2", "input", ByFormula, kConstant, kLogarithm2},
    {"torch.log10 Tensor.log10 np.log10 math.log10", "input", ByFormula, kConstant, kLogarithm10},
    {"torch.sinh np.sinh math.sinh Tensor.sinh", "input", ByFormula, kConstant, kHyperbolicSine},
    {"torch.cosh np.cosh math.cosh Tensor.cosh", "input", ByFormula, kConstant, kHyperbolicCosine},
    {"torch.deg2rad Tensor.deg2rad np.deg2rad np.radians math.radians", "input", ByFormula,
     kConstant, kRadians},
    {"torch.rad2deg Tensor.rad2deg np.rad2deg np.degrees math.degrees", "input", ByFormula,
     kConstant, kDegrees},
    {"torch.isinf np.isinf math.isinf Tensor.isinf", "input", ByFormula, kConstant, kIsInfinite},
    {"torch.isfinite np.isfinite math.isfinite Tensor.isfinite", "input", ByFormula, kConstant,
     kIsFinite},
    {"torch.add Tensor.add np.add", "input other alpha=1", AsOperator, kConstant,
     As(Operator::kAdd)},
    {"torch.sub torch.subtract Tensor.sub np.subtract", "input other alpha=1", AsOperator,
     kConstant, As(Operator::kSubtract)},
    {"torch.mul torch.multiply Tensor.mul Tensor.multiply np.multiply", "input other", AsOperator,
     kConstant, As(Operator::kMultiply)},
    {"torch.div torch.divide torch.true_divide Tensor.div Tensor.true_divide np.divide",
     "input other", AsOperator, kConstant, As(Operator::kDivide)},
    {"torch.floor_divide Tensor.floor_divide np.floor_divide", "input other", AsOperator, kConstant,
     As(Operator::kFloorDivide)},
    {"torch.remainder np.mod np.remainder Tensor.remainder", "input other", AsOperator, kConstant,
     As(Operator::kRemainder)},
    {"torch.pow Tensor.pow np.power math.pow pow", "input exponent", AsOperator, kConstant,
     As(Operator::kPower)},
    {"torch.eq Tensor.eq np.equal", "input other", AsOperator, kConstant, As(Operator::kEqual)},
    {"torch.ne Tensor.ne np.not_equal", "input other", AsOperator, kConstant,
     As(Operator::kNotEqual)},
    {"torch.lt torch.less Tensor.lt np.less", "input other", AsOperator, kConstant,
     As(Operator::kLess)},
    {"torch.le torch.less_equal Tensor.le np.less_equal", "input other", AsOperator, kConstant,
     As(Operator::kLessEqual)},
    {"torch.gt torch.greater Tensor.gt np.greater", "input other", AsOperator, kConstant,
     As(Operator::kGreater)},
    {"torch.ge torch.greater_equal Tensor.ge np.greater_equal", "input other", AsOperator,
     kConstant, As(Operator::kGreaterEqual)},
    {"torch.bitwise_and np.bitwise_and Tensor.bitwise_and", "input other", AsOperator, kConstant,
     As(Operator::kAnd)},
    {"torch.bitwise_or np.bitwise_or Tensor.bitwise_or", "input other", AsOperator, kConstant,
     As(Operator::kOr)},
    {"torch.logical_and Tensor.logical_and np.logical_and", "input other", Pair, kAnd, kMakesFlag},
    {"torch.logical_or Tensor.logical_or np.logical_or", "input other", Pair, kOr, kMakesFlag},
    {"torch.logical_xor Tensor.logical_xor np.logical_xor", "input other", Pair, kNotEqual,
     kMakesFlag},
    {"torch.maximum np.maximum Tensor.maximum torch.fmax np.fmax", "input other", Pair, kMaximum,
     kKeepsType},
    {"torch.minimum np.minimum Tensor.minimum torch.fmin np.fmin", "input other", Pair, kMinimum,
     kKeepsType},
    {"torch.fmod np.fmod math.fmod Tensor.fmod", "input other", Pair, kTruncatedRemainder,
     kKeepsType},
    {"torch.atan2 torch.arctan2 Tensor.atan2 Tensor.arctan2 np.arctan2 math.atan2", "input other",
     Pair, kArcTangent2, kMakesFloat},
    {"torch.hypot Tensor.hypot np.hypot math.hypot", "input other", Hypotenuse},
    {"torch.clamp torch.clip Tensor.clamp Tensor.clip np.clip", "input min=None max=None", Clamp},
    {"torch.where np.where", "condition input=None other=None", Where},
    {"torch.clamp_min Tensor.clamp_min", "input min max=None", Clamp},
    {"torch.clamp_max Tensor.clamp_max", "input max", ClampMax},
    {"torch.addcmul Tensor.addcmul", "input tensor1 tensor2 value=1", AddProduct},
    {"torch.lerp Tensor.lerp", "input end weight", Lerp},
    {"torch.isclose np.isclose", "input other rtol=1e-5 atol=1e-8", IsClose},
};

}  // namespace

LibraryPart ElementwiseFunctions() {
  return {kElementwiseFunctions, std::size(kElementwiseFunctions)};
}

}  // namespace simwright::reward
