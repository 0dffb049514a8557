#pragma once

#include <cstdint>

namespace simwright::reward {

// The operations on one number per environment. Their semantics are torch's: minimum and maximum
// propagate NaN, rounding is to even, remainder takes the divisor's sign.
enum class ScalarOperation : std::uint8_t {
  kConstant,
  kInput,
  kBatchSize,
  // Unary operations.
  kNegate,
  kAbsolute,
  kSquareRoot,
  kExponential,
  kLogarithm,
  kSine,
  kCosine,
  kTangent,
  kArcSine,
  kArcCosine,
  kArcTangent,
  kHyperbolicTangent,
  kSigmoid,
  kFloor,
  kCeiling,
  kRound,
  kTruncate,
  kSign,
  kIsNan,
  kNot,
  kLogarithmOfOnePlus,
  kExponentialMinusOne,
  // Binary operations.
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kArcTangent2,
  kMinimum,
  kMaximum,
  kLess,
  kLessEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kTruncatedRemainder,
  kFloorRemainder,
  kFloorDivide,
  // A ternary operation: operands[0] != 0 ? operands[1] : operands[2].
  kSelect,
  // Fused operations, which only the code generator creates from chains of the above: a * b + c, c
  // - a * b, (a - b)^2 + c.
  kMultiplyAdd,
  kMultiplySubtract,
  kSquaredDifferenceAdd,
  kOperations,
  // Operations over all environments.
  kBatchSum,
  kBatchMinimum,
  kBatchMaximum,
  kBatchFlip,
  kBatchPick,
};

constexpr int kScalarOperations = static_cast<int>(ScalarOperation::kOperations);

constexpr int OperandCount(ScalarOperation operation) {
  if (operation < ScalarOperation::kNegate) return 0;
  if (operation < ScalarOperation::kAdd) return 1;
  if (operation < ScalarOperation::kSelect) return 2;
  return operation < ScalarOperation::kOperations ? 3 : 1;
}

constexpr bool CrossesEnvironments(ScalarOperation operation) {
  return operation > ScalarOperation::kOperations;
}

}  // namespace simwright::reward
