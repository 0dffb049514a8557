#include <algorithm>
#include <cmath>

#include "reward/symbolic/elaborator.h"

namespace simwright::reward {
namespace {

const char* Sign(Operator operation) {
  switch (operation) {
    case Operator::kAdd:
      return "+";
    case Operator::kSubtract:
      return "-";
    case Operator::kMultiply:
      return "*";
    case Operator::kDivide:
      return "/";
    case Operator::kFloorDivide:
      return "//";
    case Operator::kRemainder:
      return "%";
    case Operator::kPower:
      return "**";
    case Operator::kMatrixMultiply:
      return "@";
    case Operator::kAnd:
      return "&";
    case Operator::kOr:
      return "|";
    case Operator::kExclusiveOr:
      return "^";
    default:
      return "this";
  }
}

bool Numeric(const Value& value) {
  return value.IsNumber() || value.Is(ValueKind::kTensor) || value.Is(ValueKind::kBatchSize);
}

[[noreturn]] void Overflow(Position position) {
  Fail("bad-number", position, "the result does not fit 64 bits");
}

Value IntegerBinary(Operator operation, std::int64_t a, std::int64_t b, Position position) {
  std::int64_t result = 0;
  bool overflow = false;
  switch (operation) {
    case Operator::kAdd:
      overflow = __builtin_add_overflow(a, b, &result);
      break;
    case Operator::kSubtract:
      overflow = __builtin_sub_overflow(a, b, &result);
      break;
    case Operator::kMultiply:
      overflow = __builtin_mul_overflow(a, b, &result);
      break;
    case Operator::kFloorDivide:
    case Operator::kRemainder: {
      if (b == -1) {
        overflow = __builtin_sub_overflow(std::int64_t{0}, a, &result);
        if (operation == Operator::kRemainder) return IntegerValue(0);
        break;
      }
      const std::int64_t quotient = a / b, rest = a % b;
      const bool down = rest != 0 && ((rest < 0) != (b < 0));
      result =
          operation == Operator::kFloorDivide ? quotient - (down ? 1 : 0) : rest + (down ? b : 0);
      break;
    }
    case Operator::kPower: {
      if (b < 0) return FloatValue(std::pow(static_cast<double>(a), static_cast<double>(b)));
      result = 1;
      for (std::int64_t i = 0; i < b && !overflow && a != 0 && a != 1; ++i) {
        if (a == -1) {
          result = b % 2 == 0 ? 1 : -1;
          break;
        }
        overflow = __builtin_mul_overflow(result, a, &result);
      }
      if (a == 0) result = b == 0 ? 1 : 0;
      break;
    }
    case Operator::kAnd:
      result = a & b;
      break;
    case Operator::kOr:
      result = a | b;
      break;
    case Operator::kExclusiveOr:
      result = a ^ b;
      break;
    default:
      Fail("type", position, std::string(Sign(operation)) + " has no meaning on numbers");
  }
  if (overflow) Overflow(position);
  return IntegerValue(result);
}

Value NumberBinary(Operator operation, const Value& a, const Value& b, Position position) {
  const double x = a.Number(), y = b.Number();
  const bool divides = operation == Operator::kDivide || operation == Operator::kFloorDivide ||
                       operation == Operator::kRemainder;
  if ((divides && y == 0.0) || (operation == Operator::kPower && x == 0.0 && y < 0.0)) {
    Fail("division-by-zero", position, "this divides by zero");
  }
  if (operation == Operator::kDivide) return FloatValue(x / y);
  const bool logical = operation == Operator::kAnd || operation == Operator::kOr ||
                       operation == Operator::kExclusiveOr;
  if (!a.Is(ValueKind::kFloat) && !b.Is(ValueKind::kFloat)) {
    Value result = IntegerBinary(operation, a.integer, b.integer, position);
    if (logical && a.Is(ValueKind::kBool) && b.Is(ValueKind::kBool)) result.kind = ValueKind::kBool;
    return result;
  }
  switch (operation) {
    case Operator::kAdd:
      return FloatValue(x + y);
    case Operator::kSubtract:
      return FloatValue(x - y);
    case Operator::kMultiply:
      return FloatValue(x * y);
    case Operator::kFloorDivide:
      return FloatValue(std::floor(x / y));
    case Operator::kRemainder: {
      const double rest = std::fmod(x, y);
      return FloatValue(rest != 0.0 && ((rest < 0.0) != (y < 0.0)) ? rest + y : rest);
    }
    case Operator::kPower:
      return FloatValue(std::pow(x, y));
    default:
      Fail("type", position,
           "'" + std::string(Sign(operation)) +
               "' joins flags; compare the numbers first, in brackets: (a < 1) " + Sign(operation) +
               " (b < 2)");
  }
}

struct TensorOperation {
  ScalarOperation operation;
  DataType type;
};

// Returns torch's operation for an operator on operands that promote to `type`.
TensorOperation Resolve(Operator operation, DataType type, Position position) {
  const bool flags = type == DataType::kBool;
  switch (operation) {
    case Operator::kAdd:
      return {flags ? ScalarOperation::kOr : ScalarOperation::kAdd, type};
    case Operator::kSubtract:
      if (flags) {
        Fail("type", position,
             "flags cannot be subtracted; use torch.logical_xor, or .float() them first");
      }
      return {ScalarOperation::kSubtract, type};
    case Operator::kMultiply:
      return {flags ? ScalarOperation::kAnd : ScalarOperation::kMultiply, type};
    case Operator::kDivide:
      return {ScalarOperation::kDivide, DataType::kFloat};
    case Operator::kFloorDivide:
      return {ScalarOperation::kFloorDivide, type};
    case Operator::kRemainder:
      return {ScalarOperation::kFloorRemainder, type};
    case Operator::kPower:
      return {ScalarOperation::kPower, flags ? DataType::kInteger : type};
    case Operator::kAnd:
    case Operator::kOr:
    case Operator::kExclusiveOr:
      break;
    default:
      Fail("type", position, "this operator has no meaning on tensors");
  }
  if (!flags) {
    Fail("type", position,
         "'" + std::string(Sign(operation)) +
             "' joins flags; compare the numbers first, in brackets: (a < 1) " + Sign(operation) +
             " (b < 2)");
  }
  if (operation == Operator::kAnd) return {ScalarOperation::kAnd, type};
  return {operation == Operator::kOr ? ScalarOperation::kOr : ScalarOperation::kNotEqual, type};
}

bool Equal(const Value& a, const Value& b, int* budget) {
  if (--*budget < 0) return false;
  if (a.IsNumber() && b.IsNumber()) return a.Number() == b.Number();
  if (a.kind != b.kind || a.text != b.text || a.object != b.object) return false;
  if (!a.Is(ValueKind::kTuple) || a.items == b.items) return true;
  if (a.items->size() != b.items->size()) return false;
  for (std::size_t i = 0; i < a.items->size(); ++i) {
    if (!Equal((*a.items)[i], (*b.items)[i], budget)) return false;
  }
  return true;
}

}  // namespace

Value Elaborator::BinaryTensors(Operator operation, const Value& a, const Value& b,
                                Position position) {
  const Tensor left = math_.FromValue(a, position), right = math_.FromValue(b, position);
  const DataType type = Promote(left.type, right.type);
  float exponent = 0.0f;
  if (operation == Operator::kPower && type == DataType::kInteger &&
      graph_.IsConstant(math_.At(right, 0), &exponent) && exponent < 0.0f) {
    Fail("type", position, "whole numbers to a negative power; .float() them first");
  }
  const TensorOperation meant = Resolve(operation, type, position);
  if (operation == Operator::kSubtract) WarnAboutSelfDistance(left, right, position);
  return TensorValue(math_.Map(meant.operation, left, right, meant.type, position));
}

void Elaborator::WarnAboutSelfDistance(const Tensor& a, const Tensor& b, Position position) {
  const std::vector<NodeId> nodes = math_.Nodes(a);
  if (nodes != math_.Nodes(b)) return;
  if (std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) { return graph_.IsConstant(n); })) {
    return;
  }
  Report("self-distance", core::Severity::kWarning, position,
         "both sides are the same thing: the difference is always zero");
}

Value Elaborator::Binary(Operator operation, const Value& a, const Value& b, Position position) {
  for (const Value* value : {&a, &b}) {
    if (value->Is(ValueKind::kUndefined)) math_.FromValue(*value, position);  // throws
  }
  if (operation == Operator::kMatrixMultiply) {
    Arguments arguments;
    arguments.called = "@";
    arguments.position = position;
    arguments.values = {a, b};
    arguments.places = {position, position};
    arguments.given = {true, true};
    arguments.function = FindLibraryFunction("torch.matmul");
    return arguments.function->handler(*this, arguments);
  }
  if (a.IsNumber() && b.IsNumber()) return NumberBinary(operation, a, b, position);
  if (Numeric(a) && Numeric(b)) return BinaryTensors(operation, a, b, position);
  const bool adds = operation == Operator::kAdd;
  if (adds && a.Is(ValueKind::kString) && b.Is(ValueKind::kString)) {
    if (a.text.size() + b.text.size() > 4096) {
      Fail("too-large", position, "the string is longer than 4096 characters");
    }
    return StringValue(a.text + b.text);
  }
  const auto sequence = [](const Value& value) {
    return value.Is(ValueKind::kList) || value.Is(ValueKind::kTuple);
  };
  if (adds && sequence(a) && a.kind == b.kind) {
    std::vector<Value> items = Items(a, position);
    for (Value& item : Items(b, position)) items.push_back(std::move(item));
    const Value list = NewList(std::move(items));
    return a.Is(ValueKind::kList) ? list : TupleValue(*heap_[list.object].items);
  }
  if (operation == Operator::kMultiply && sequence(a) && b.Is(ValueKind::kInteger)) {
    const std::vector<Value> once = Items(a, position);
    std::vector<Value> items;
    for (std::int64_t i = 0; i < b.integer && !once.empty(); ++i) {
      if (items.size() > static_cast<std::size_t>(options_.max_lanes)) break;  // NewList throws
      items.insert(items.end(), once.begin(), once.end());
    }
    const Value list = NewList(std::move(items));
    return a.Is(ValueKind::kList) ? list : TupleValue(*heap_[list.object].items);
  }
  const bool formats = operation == Operator::kRemainder && a.Is(ValueKind::kString);
  Fail("type", position,
       "'" + std::string(Sign(operation)) + "' has no meaning between " + Describe(a) + " and " +
           Describe(b) + (formats ? "; write an f-string, f\"{name:.2f}\"" : ""));
}

Value Elaborator::Compare(Operator operation, const Value& a, const Value& b, Position position) {
  for (const Value* value : {&a, &b}) {
    if (value->Is(ValueKind::kUndefined)) math_.FromValue(*value, position);  // throws
  }
  int budget = options_.max_lanes;
  if (operation == Operator::kIs || operation == Operator::kIsNot) {
    const bool none = a.Is(ValueKind::kNone) || b.Is(ValueKind::kNone);
    const bool same = none ? a.kind == b.kind : !Numeric(a) && Equal(a, b, &budget);
    return BoolValue(same == (operation == Operator::kIs));
  }
  if (operation == Operator::kIn || operation == Operator::kNotIn) {
    bool found = false;
    for (const Value& item : Items(b, position)) found = found || Equal(item, a, &budget);
    return BoolValue(found == (operation == Operator::kIn));
  }
  const bool equality = operation == Operator::kEqual || operation == Operator::kNotEqual;
  if (a.IsNumber() && b.IsNumber()) {
    const double x = a.Number(), y = b.Number();
    switch (operation) {
      case Operator::kLess:
        return BoolValue(x < y);
      case Operator::kLessEqual:
        return BoolValue(x <= y);
      case Operator::kGreater:
        return BoolValue(x > y);
      case Operator::kGreaterEqual:
        return BoolValue(x >= y);
      case Operator::kEqual:
        return BoolValue(x == y);
      default:
        return BoolValue(x != y);
    }
  }
  if (Numeric(a) && Numeric(b)) {
    const bool swap = operation == Operator::kGreater || operation == Operator::kGreaterEqual;
    const Tensor x = math_.FromValue(swap ? b : a, position);
    const Tensor y = math_.FromValue(swap ? a : b, position);
    const ScalarOperation meant = operation == Operator::kEqual      ? ScalarOperation::kEqual
                                  : operation == Operator::kNotEqual ? ScalarOperation::kNotEqual
                                  : operation == Operator::kLess || operation == Operator::kGreater
                                      ? ScalarOperation::kLess
                                      : ScalarOperation::kLessEqual;
    return TensorValue(math_.Map(meant, x, y, DataType::kBool, position));
  }
  if (equality) {
    const bool same = Equal(a, b, &budget);
    return BoolValue(same == (operation == Operator::kEqual));
  }
  Fail("type", position, Describe(a) + " and " + Describe(b) + " cannot be compared");
}

Value Elaborator::Negate(const Value& value, Position position) {
  if (value.Is(ValueKind::kFloat)) return FloatValue(-value.number);
  if (value.IsNumber()) return IntegerBinary(Operator::kSubtract, 0, value.integer, position);
  const Tensor tensor = math_.FromValue(value, position);
  if (tensor.type == DataType::kBool) {
    Fail("type", position, "a flag cannot be negated with '-'; use '~', or .float() it first");
  }
  return TensorValue(math_.Map(ScalarOperation::kNegate, tensor, tensor.type, position));
}

Value Elaborator::Invert(const Value& value, Position position) {
  if (value.Is(ValueKind::kFloat)) Fail("type", position, "'~' inverts flags, this is a number");
  if (value.IsNumber()) return IntegerValue(~value.integer);
  const Tensor tensor = math_.FromValue(value, position);
  if (tensor.type == DataType::kFloat) {
    Fail("type", position,
         "'~' inverts flags, this is " + Describe(value) +
             "; compare it first, in brackets: ~(x < 1)");
  }
  if (tensor.type == DataType::kBool) {
    return TensorValue(math_.Map(ScalarOperation::kNot, tensor, tensor.type, position));
  }
  const Tensor minus_one = math_.Scalar(DataType::kInteger, graph_.Constant(-1.0));
  return TensorValue(
      math_.Map(ScalarOperation::kSubtract, minus_one, tensor, tensor.type, position));
}

}  // namespace simwright::reward
