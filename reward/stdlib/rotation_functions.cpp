// Isaac Gym's rotations, on quaternions xyzw in the last dimension.
#include <cmath>

#include "reward/stdlib/library_arguments.h"

namespace simwright::reward {
namespace {

using enum ScalarOperation;

// Arithmetic on columns for one call.
class RotationColumns {
 public:
  RotationColumns(Elaborator& elaborator, Position position)
      : math_(elaborator.math()), position_(position) {}

  // Returns the parts of the last dimension, which must have size `size`.
  std::vector<Tensor> Split(const Tensor& tensor, int size, const char* what) {
    if (tensor.shape.empty() || tensor.shape.back() != size) {
      Fail("shape", position_,
           std::string(what) + " has to be [.., " + std::to_string(size) + "], this is " +
               ShapeText(tensor.shape));
    }
    const int last = static_cast<int>(tensor.shape.size()) - 1;
    std::vector<Tensor> parts;
    for (int i = 0; i < size; ++i) parts.push_back(math_.Take(tensor, last, i, position_));
    return parts;
  }

  Tensor Join(std::vector<Tensor> parts) {
    Shape shape;
    for (const Tensor& part : parts) shape = math_.Broadcast(shape, part.shape, position_);
    for (Tensor& part : parts) {
      part = math_.Unsqueeze(math_.Expand(part, shape, position_), static_cast<int>(shape.size()));
    }
    return math_.Concatenate(parts, static_cast<int>(shape.size()), position_);
  }

  Tensor Number(double value) {
    return math_.Scalar(DataType::kFloat, math_.graph().Constant(value));
  }
  Tensor Do(ScalarOperation operation, const Tensor& a) {
    return math_.Map(operation, a, DataType::kFloat, position_);
  }
  Tensor Do(ScalarOperation operation, const Tensor& a, const Tensor& b) {
    return math_.Map(operation, a, b, DataType::kFloat, position_);
  }
  Tensor Add(const Tensor& a, const Tensor& b) { return Do(kAdd, a, b); }
  Tensor Subtract(const Tensor& a, const Tensor& b) { return Do(kSubtract, a, b); }
  Tensor Multiply(const Tensor& a, const Tensor& b) { return Do(kMultiply, a, b); }

  using Vector = std::vector<Tensor>;
  Vector Cross(const Vector& a, const Vector& b) {
    Vector result;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      result.push_back(Subtract(Multiply(a[j], b[k]), Multiply(a[k], b[j])));
    }
    return result;
  }
  // Returns v rotated by q, or by its inverse: v + 2 w (u x v) + 2 u x (u x v), where u is the
  // imaginary part. Computed for unit quaternions as in Isaac Gym: (2 w^2 - 1) v +- 2 w (u x v) + 2
  // u (u . v).
  Vector Rotate(const Vector& q, const Vector& v, bool inverse) {
    const Tensor two = Number(2.0);
    const Tensor scale = Subtract(Multiply(two, Multiply(q[3], q[3])), Number(1.0));
    const Tensor dot = Add(Add(Multiply(q[0], v[0]), Multiply(q[1], v[1])), Multiply(q[2], v[2]));
    const Vector cross = Cross(q, v);
    Vector result;
    for (int i = 0; i < 3; ++i) {
      const Tensor a = Multiply(scale, v[i]);
      const Tensor b = Multiply(Multiply(two, q[3]), cross[i]);
      const Tensor c = Multiply(Multiply(two, q[i]), dot);
      result.push_back(Add(inverse ? Subtract(a, b) : Add(a, b), c));
    }
    return result;
  }
  // Returns v + w t + u x t with t = 2 u x v.
  Vector Apply(const Vector& q, const Vector& v) {
    Vector t = Cross(q, v);
    for (Tensor& part : t) part = Multiply(part, Number(2.0));
    const Vector turn = Cross(q, t);
    Vector result;
    for (int i = 0; i < 3; ++i) {
      result.push_back(Add(Add(v[i], Multiply(q[3], t[i])), turn[i]));
    }
    return result;
  }
  Vector Product(const Vector& a, const Vector& b) {
    const auto m = [&](int i, int j) { return Multiply(a[i], b[j]); };
    return {Subtract(Add(Add(m(3, 0), m(0, 3)), m(1, 2)), m(2, 1)),
            Add(Subtract(Add(m(3, 1), m(1, 3)), m(0, 2)), m(2, 0)),
            Subtract(Add(Add(m(3, 2), m(2, 3)), m(0, 1)), m(1, 0)),
            Subtract(Subtract(Subtract(m(3, 3), m(0, 0)), m(1, 1)), m(2, 2))};
  }
  Vector Conjugate(const Vector& q) {
    return {Do(kNegate, q[0]), Do(kNegate, q[1]), Do(kNegate, q[2]), q[3]};
  }
  // Wraps an angle to [-pi, pi].
  Tensor WrapAngle(const Tensor& angle) {
    return Do(kArcTangent2, Do(kSine, angle), Do(kCosine, angle));
  }

 private:
  TensorMath& math_;
  Position position_;
};

enum Turn { kRotate, kRotateInverse, kApply };

Value TurnVector(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto q = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  const auto v = columns.Split(FloatArgument(elaborator, arguments, 1), 3, "a vector");
  const int turn = arguments.function->variant;
  return TensorValue(columns.Join(turn == kApply ? columns.Apply(q, v)
                                                 : columns.Rotate(q, v, turn == kRotateInverse)));
}

Value Multiply(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto a = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  const auto b = columns.Split(FloatArgument(elaborator, arguments, 1), 4, "a quaternion");
  return TensorValue(columns.Join(columns.Product(a, b)));
}

Value Conjugate(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto q = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  return TensorValue(columns.Join(columns.Conjugate(q)));
}

Value FromAngleAxis(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const Tensor half =
      columns.Multiply(FloatArgument(elaborator, arguments, 0), columns.Number(0.5));
  auto axis = columns.Split(FloatArgument(elaborator, arguments, 1), 3, "an axis");
  Tensor squares = columns.Multiply(axis[0], axis[0]);
  for (int i = 1; i < 3; ++i) squares = columns.Add(squares, columns.Multiply(axis[i], axis[i]));
  const Tensor length =
      columns.Do(kMaximum, columns.Do(kSquareRoot, squares), columns.Number(1e-9));
  std::vector<Tensor> parts;
  for (const Tensor& one : axis) {
    parts.push_back(columns.Multiply(columns.Do(kDivide, one, length), columns.Do(kSine, half)));
  }
  parts.push_back(columns.Do(kCosine, half));
  return TensorValue(columns.Join(std::move(parts)));
}

// Returns the angle between two orientations: 2 asin |imaginary part of a b*|.
Value Difference(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto a = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  const auto b = columns.Split(FloatArgument(elaborator, arguments, 1), 4, "a quaternion");
  const auto turn = columns.Product(a, columns.Conjugate(b));
  Tensor squares = columns.Multiply(turn[0], turn[0]);
  for (int i = 1; i < 3; ++i) squares = columns.Add(squares, columns.Multiply(turn[i], turn[i]));
  const Tensor size = columns.Do(kMinimum, columns.Do(kSquareRoot, squares), columns.Number(1.0));
  return TensorValue(columns.Multiply(columns.Number(2.0), columns.Do(kArcSine, size)));
}

// Returns axis `axis` of the frame that a quaternion rotates.
Value Axis(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto q = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  const std::int64_t axis = IntegerArgument(elaborator, arguments, 1);
  if (axis < 0 || axis > 2) Fail("index", arguments.Place(1), "the axis is 0, 1 or 2");
  std::vector<Tensor> unit(3, columns.Number(0.0));
  unit[axis] = columns.Number(1.0);
  return TensorValue(columns.Join(columns.Rotate(q, unit, false)));
}

Value NormalizeAngle(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  return TensorValue(columns.WrapAngle(FloatArgument(elaborator, arguments, 0)));
}

// Returns roll, pitch and yaw, each in [0, 2 pi) as in Isaac Gym.
Value EulerAngles(Elaborator& elaborator, const Arguments& arguments) {
  RotationColumns columns(elaborator, arguments.position);
  const auto q = columns.Split(FloatArgument(elaborator, arguments, 0), 4, "a quaternion");
  const auto m = [&](int i, int j) { return columns.Multiply(q[i], q[j]); };
  const auto twice = [&](const Tensor& a) { return columns.Multiply(columns.Number(2.0), a); };
  const Tensor roll = columns.Do(
      kArcTangent2, twice(columns.Add(m(3, 0), m(1, 2))),
      columns.Add(columns.Subtract(columns.Subtract(m(3, 3), m(0, 0)), m(1, 1)), m(2, 2)));
  const Tensor sine = twice(columns.Subtract(m(3, 1), m(2, 0)));
  const Tensor clipped =
      columns.Do(kMinimum, columns.Do(kMaximum, sine, columns.Number(-1.0)), columns.Number(1.0));
  const Tensor yaw = columns.Do(
      kArcTangent2, twice(columns.Add(m(3, 2), m(0, 1))),
      columns.Subtract(columns.Subtract(columns.Add(m(3, 3), m(0, 0)), m(1, 1)), m(2, 2)));
  std::vector<Value> angles;
  for (const Tensor& angle : {roll, columns.Do(kArcSine, clipped), yaw}) {
    angles.push_back(
        TensorValue(columns.Do(kFloorRemainder, angle, columns.Number(6.283185307179586))));
  }
  return TupleValue(std::move(angles));
}

constexpr LibraryFunction kRotationFunctions[] = {
    {"quat_rotate my_quat_rotate", "q v", TurnVector, kConstant, kRotate},
    {"quat_rotate_inverse", "q v", TurnVector, kConstant, kRotateInverse},
    {"quat_apply", "a b", TurnVector, kConstant, kApply},
    {"quat_mul", "a b", Multiply},
    {"quat_conjugate", "a", Conjugate},
    {"quat_from_angle_axis", "angle axis", FromAngleAxis},
    {"quat_diff_rad", "a b", Difference},
    {"quat_axis", "q axis=0", Axis},
    {"normalize_angle", "x", NormalizeAngle},
    {"get_euler_xyz", "q", EulerAngles},
};

}  // namespace

LibraryPart RotationFunctions() {
  return {kRotationFunctions, std::size(kRotationFunctions)};
}

}  // namespace simwright::reward
