#pragma once

// Loops over columns of numbers, compiled for the instruction set that the namespace
// SIMWRIGHT_KERNEL_ISA names (kernels_plain.cpp and its siblings). The loops have no branches, so
// the compiler vectorises them. Polynomials are minimax or Taylor; each states its error.
namespace simwright::reward::SIMWRIGHT_KERNEL_ISA {

// Compiler built-ins replace standard library functions: a function that was compiled with other
// options is not inlined here.
inline float Choose(bool condition, float yes, float no) {
  return condition ? yes : no;
}

// Returns e^x, within 2e-7 of its value.
inline float Exponential(float x) {
  const float inside = Choose(x < -87.3f, -87.3f, Choose(x > 88.7f, 88.7f, x));
  // Adding 1.5 * 2^23 rounds to a whole number and leaves it in the low bits.
  const float shifted = inside * 1.44269504f + 12582912.0f;
  const float whole = shifted - 12582912.0f;
  const float r = (inside - whole * 0.693359375f) + whole * 2.12194440e-4f;
  const float p =
      1.0f +
      r * (1.0f +
           r * (0.5f + r * (1.66666667e-1f +
                            r * (4.16666667e-2f + r * (8.33333333e-3f + r * 1.38888889e-3f)))));
  // 2^n as 2 * 2^(n-1): n itself reaches 128.
  const auto bits = __builtin_bit_cast(std::uint32_t, shifted);
  const float scale = __builtin_bit_cast(float, (bits + 126u) << 23);
  const float value = p * scale * 2.0f;
  return Choose(x > 88.7228f, std::numeric_limits<float>::infinity(),
                Choose(x < -87.3f, 0.0f, value));
}

// Returns log(m) for m in [sqrt(1/2), sqrt(2)], given t = m - 1: 2 artanh(t / (2 + t)) by its
// series, within 1e-7 of its value.
inline float LogarithmNearOne(float t) {
  const float s = t / (2.0f + t);
  const float q = s * s;
  const float tail = q * (1.0f / 3 + q * (1.0f / 5 + q * (1.0f / 7 + q * (1.0f / 9))));
  return 2.0f * (s + s * tail);
}

inline float Logarithm(float x) {
  // Numbers below the smallest normal one are scaled up first.
  const bool tiny = x < 1.17549435e-38f;
  const float lifted = Choose(tiny, x * 8388608.0f, x);
  // The subtraction is unsigned, since the bits of negative numbers and NaN wrap around.
  const auto bits = __builtin_bit_cast(std::uint32_t, lifted);
  const std::int32_t exponent = static_cast<std::int32_t>(bits - 0x3f3504f3u) >> 23;
  const float m = __builtin_bit_cast(float, bits - (static_cast<std::uint32_t>(exponent) << 23));
  const float e = static_cast<float>(exponent) - Choose(tiny, 23.0f, 0.0f);
  const float value = e * 0.693359375f + (LogarithmNearOne(m - 1.0f) - e * 2.12194440e-4f);
  const float infinity = std::numeric_limits<float>::infinity();
  const float low = Choose(x == 0.0f, -infinity, std::numeric_limits<float>::quiet_NaN());
  return Choose(x == infinity || x != x, x, Choose(x <= 0.0f, low, value));
}

// Return sin(r) and cos(r) for |r| <= pi/4, within 1e-7.
inline float SineNearZero(float r) {
  const float q = r * r;
  return r +
         r * q *
             (-1.66666667e-1f + q * (8.33333333e-3f + q * (-1.98412698e-4f + q * 2.75573192e-6f)));
}
inline float CosineNearZero(float r) {
  const float q = r * r;
  return 1.0f + q * (-0.5f + q * (4.16666667e-2f + q * (-1.38888889e-3f + q * 2.48015873e-5f)));
}

// The largest angle for the three-part reduction by pi/2, which loses digits beyond it: larger
// angles use the standard library.
constexpr float kLargestAngle = 8192.0f;

// Returns sin(x + quarters * pi/2) for |x| <= kLargestAngle.
inline float SineOfQuarters(float x, std::uint32_t quarters) {
  const float shifted = x * 0.636619772f + 12582912.0f;
  const float whole = shifted - 12582912.0f;
  const float r =
      ((x - whole * 1.5703125f) - whole * 4.837512969970703125e-4f) - whole * 7.549789948768648e-8f;
  const std::uint32_t quadrant = __builtin_bit_cast(std::uint32_t, shifted) + quarters;
  const float size = Choose((quadrant & 1) != 0, CosineNearZero(r), SineNearZero(r));
  return Choose((quadrant & 2) != 0, -size, size);
}

// Returns asin(x) for |x| <= 1/2, within 2e-7.
inline float ArcSineNearZero(float x) {
  const float q = x * x;
  return x + x * q *
                 (1.6666667e-1f +
                  q * (7.4999995e-2f +
                       q * (4.4646284e-2f +
                            q * (3.0293402e-2f +
                                 q * (2.3073306e-2f + q * (1.3055688e-2f + q * 3.1877e-2f))))));
}

inline float ArcSine(float x) {
  const float size = Choose(x < 0.0f, -x, x);
  const bool far = size > 0.5f;
  const float inner = Choose(far, __builtin_sqrtf((1.0f - size) * 0.5f), size);
  const float near = ArcSineNearZero(inner);
  const float value = Choose(far, 1.57079633f - 2.0f * near, near);
  return Choose(x < 0.0f, -value, value);
}

inline float ArcCosine(float x) {
  const float size = Choose(x < 0.0f, -x, x);
  const float near = ArcSineNearZero(Choose(size > 0.5f, __builtin_sqrtf((1.0f - size) * 0.5f), x));
  const float far = Choose(x < 0.0f, 3.14159265f - 2.0f * near, 2.0f * near);
  return Choose(size > 0.5f, far, 1.57079633f - near);
}

inline float ArcTangent(float x) {
  const float size = Choose(x < 0.0f, -x, x);
  const bool large = size > 2.41421356f, middle = size > 0.414213562f;
  const float t = Choose(large, -1.0f / size, Choose(middle, (size - 1.0f) / (size + 1.0f), size));
  const float start = Choose(large, 1.57079633f, Choose(middle, 0.785398163f, 0.0f));
  const float q = t * t;
  const float series =
      t +
      t * q *
          (-3.33333331e-1f +
           q * (1.99999206e-1f +
                q * (-1.42815640e-1f + q * (1.10190408e-1f + q * (-8.2474300e-2f + q * 4.0e-2f)))));
  const float value = start + series;
  return Choose(x < 0.0f, -value, value);
}

inline float ArcTangent2(float y, float x) {
  const float size_y = Choose(y < 0.0f, -y, y), size_x = Choose(x < 0.0f, -x, x);
  const bool steep = size_y > size_x;
  const float low = Choose(steep, size_x, size_y), high = Choose(steep, size_y, size_x);
  const float ratio = Choose(high == 0.0f, 0.0f, Choose(low == high, 1.0f, low / high));
  const float acute = ArcTangent(ratio);
  const float upper = Choose(steep, 1.57079633f - acute, acute);
  const float value = Choose(__builtin_bit_cast(std::int32_t, x) < 0, 3.14159265f - upper, upper);
  const float signed_value = Choose(__builtin_bit_cast(std::int32_t, y) < 0, -value, value);
  return Choose(x != x || y != y, x + y, signed_value);
}

inline float HyperbolicTangent(float x) {
  const float size = Choose(x < 0.0f, -x, x);
  const float q = x * x;
  const float near =
      x + x * q *
              (-3.33333313e-1f +
               q * (1.33331472e-1f + q * (-5.39397757e-2f + q * (2.13890374e-2f - q * 6.8e-3f))));
  const float far = 1.0f - 2.0f / (Exponential(2.0f * size) + 1.0f);
  return Choose(size < 0.4f, near, Choose(x < 0.0f, -far, far));
}

inline float Sigmoid(float x) {
  return 1.0f / (1.0f + Exponential(-x));
}

inline float Minimum(float a, float b) {
  return Choose(a < b || a != a, a, b);
}
inline float Maximum(float a, float b) {
  return Choose(a > b || a != a, a, b);
}

inline float FloorRemainder(float a, float b) {
  const float r = std::fmod(a, b);
  return r != 0.0f && ((r < 0.0f) != (b < 0.0f)) ? r + b : r;
}

inline float FloorDivide(float a, float b) {
  if (b == 0.0f) return a / b;
  const float remainder = std::fmod(a, b);
  float quotient = (a - remainder) / b;
  if (remainder != 0.0f && ((b < 0.0f) != (remainder < 0.0f))) quotient -= 1.0f;
  const float whole = __builtin_floorf(quotient);
  return quotient - whole > 0.5f ? whole + 1.0f : whole;
}

#define SIMWRIGHT_OPERATION(name, expression)                                  \
  struct name {                                                                \
    static inline float Of([[maybe_unused]] float a, [[maybe_unused]] float b, \
                           [[maybe_unused]] float c) {                         \
      return expression;                                                       \
    }                                                                          \
  };

SIMWRIGHT_OPERATION(NegateOf, -a)
SIMWRIGHT_OPERATION(AbsoluteOf, __builtin_fabsf(a))
SIMWRIGHT_OPERATION(SquareRootOf, __builtin_sqrtf(a))
SIMWRIGHT_OPERATION(ExponentialOf, Exponential(a))
SIMWRIGHT_OPERATION(LogarithmOf, Logarithm(a))
SIMWRIGHT_OPERATION(SineOf, SineOfQuarters(a, 0))
SIMWRIGHT_OPERATION(CosineOf, SineOfQuarters(a, 1))
SIMWRIGHT_OPERATION(TangentOf, std::tan(a))
SIMWRIGHT_OPERATION(ArcSineOf, ArcSine(a))
SIMWRIGHT_OPERATION(ArcCosineOf, ArcCosine(a))
SIMWRIGHT_OPERATION(ArcTangentOf, ArcTangent(a))
SIMWRIGHT_OPERATION(HyperbolicTangentOf, HyperbolicTangent(a))
SIMWRIGHT_OPERATION(SigmoidOf, Sigmoid(a))
SIMWRIGHT_OPERATION(FloorOf, __builtin_floorf(a))
SIMWRIGHT_OPERATION(CeilingOf, __builtin_ceilf(a))
SIMWRIGHT_OPERATION(RoundOf, __builtin_nearbyintf(a))
SIMWRIGHT_OPERATION(TruncateOf, __builtin_truncf(a))
SIMWRIGHT_OPERATION(SignOf, Choose(a > 0.0f, 1.0f, Choose(a < 0.0f, -1.0f, 0.0f)))
SIMWRIGHT_OPERATION(IsNanOf, Choose(a != a, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(NotOf, Choose(a == 0.0f, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(LogarithmOfOnePlusOf, std::log1p(a))
SIMWRIGHT_OPERATION(ExponentialMinusOneOf, std::expm1(a))
SIMWRIGHT_OPERATION(AddOf, a + b)
SIMWRIGHT_OPERATION(SubtractOf, a - b)
SIMWRIGHT_OPERATION(MultiplyOf, a* b)
SIMWRIGHT_OPERATION(DivideOf, a / b)
SIMWRIGHT_OPERATION(PowerOf, std::pow(a, b))
SIMWRIGHT_OPERATION(ArcTangent2Of, ArcTangent2(a, b))
SIMWRIGHT_OPERATION(MinimumOf, Minimum(a, b))
SIMWRIGHT_OPERATION(MaximumOf, Maximum(a, b))
SIMWRIGHT_OPERATION(LessOf, Choose(a < b, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(LessEqualOf, Choose(a <= b, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(EqualOf, Choose(a == b, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(NotEqualOf, Choose(a != b, 1.0f, 0.0f))
SIMWRIGHT_OPERATION(AndOf, Choose((a != 0.0f) & (b != 0.0f), 1.0f, 0.0f))
SIMWRIGHT_OPERATION(OrOf, Choose((a != 0.0f) | (b != 0.0f), 1.0f, 0.0f))
SIMWRIGHT_OPERATION(TruncatedRemainderOf, std::fmod(a, b))
SIMWRIGHT_OPERATION(FloorRemainderOf, FloorRemainder(a, b))
SIMWRIGHT_OPERATION(FloorDivideOf, FloorDivide(a, b))
SIMWRIGHT_OPERATION(SelectOf, Choose(a != 0.0f, b, c))
SIMWRIGHT_OPERATION(MultiplyAddOf, a* b + c)
SIMWRIGHT_OPERATION(MultiplySubtractOf, c - a * b)
SIMWRIGHT_OPERATION(SquaredDifferenceAddOf, (a - b) * (a - b) + c)
#undef SIMWRIGHT_OPERATION

// Applies an operation to columns. Bits of kUniform mark operands that are one number for all
// environments.
template <typename Operation, int kOperands, int kUniform>
void Loop(float* __restrict result, const float* __restrict a, const float* __restrict b,
          const float* __restrict c, int count) {
  constexpr bool kA = (kUniform & 1) != 0, kB = (kUniform & 2) != 0, kC = (kUniform & 4) != 0;
  const float first = kA ? a[0] : 0.0f;
  const float second = kOperands > 1 && kB ? b[0] : 0.0f;
  const float third = kOperands > 2 && kC ? c[0] : 0.0f;
  for (int i = 0; i < count; ++i) {
    const float x = kA ? first : a[i];
    const float y = kOperands < 2 || kB ? second : b[i];
    const float z = kOperands < 3 || kC ? third : c[i];
    result[i] = Operation::Of(x, y, z);
  }
}

// Computes sines or cosines, with the standard library for large angles.
template <typename Operation, bool kSine>
void AngleLoop(float* __restrict result, const float* __restrict a, const float* b, const float* c,
               int count) {
  Loop<Operation, 1, 0>(result, a, b, c, count);
  int large = 0;
  for (int i = 0; i < count; ++i) large |= !(__builtin_fabsf(a[i]) <= kLargestAngle);
  if (large == 0) return;
  for (int i = 0; i < count; ++i) {
    if (!(__builtin_fabsf(a[i]) <= kLargestAngle))
      result[i] = kSine ? std::sin(a[i]) : std::cos(a[i]);
  }
}

typedef float Eight __attribute__((vector_size(32)));

// Splits rows x0 y0 z0 x1 ... into columns. Eight rows occupy three vectors, in which no two
// numbers of one column share a position.
inline void SplitTriples(const float* __restrict rows, float* const columns[3], int count) {
  float* __restrict x = columns[0];
  float* __restrict y = columns[1];
  float* __restrict z = columns[2];
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    Eight a, b, c;
    std::memcpy(&a, rows + 3 * i, sizeof(a));
    std::memcpy(&b, rows + 3 * i + 8, sizeof(b));
    std::memcpy(&c, rows + 3 * i + 16, sizeof(c));
    Eight p = __builtin_shufflevector(a, b, 0, 9, 2, 3, 12, 5, 6, 15);
    p = __builtin_shufflevector(p, c, 0, 1, 10, 3, 4, 13, 6, 7);
    p = __builtin_shufflevector(p, p, 0, 3, 6, 1, 4, 7, 2, 5);
    Eight q = __builtin_shufflevector(a, b, 0, 1, 10, 3, 4, 13, 6, 7);
    q = __builtin_shufflevector(q, c, 8, 1, 2, 11, 4, 5, 14, 7);
    q = __builtin_shufflevector(q, q, 1, 4, 7, 2, 5, 0, 3, 6);
    Eight r = __builtin_shufflevector(a, b, 8, 1, 2, 11, 4, 5, 14, 7);
    r = __builtin_shufflevector(r, c, 0, 9, 2, 3, 12, 5, 6, 15);
    r = __builtin_shufflevector(r, r, 2, 5, 0, 3, 6, 1, 4, 7);
    std::memcpy(x + i, &p, sizeof(p));
    std::memcpy(y + i, &q, sizeof(q));
    std::memcpy(z + i, &r, sizeof(r));
  }
  for (; i < count; ++i) {
    x[i] = rows[3 * i];
    y[i] = rows[3 * i + 1];
    z[i] = rows[3 * i + 2];
  }
}

inline void StoreFlags(std::uint8_t* __restrict flags, const float* __restrict a, int count) {
  for (int i = 0; i < count; ++i) flags[i] = a[i] != 0.0f ? 1 : 0;
}

// Returns the sum over a fixed number of strands, so every instruction set adds in the same order.
inline double Sum(const float* a, int count) {
  constexpr int kStrands = 8;
  double strands[kStrands] = {};
  int i = 0;
  for (; i + kStrands <= count; i += kStrands) {
    for (int k = 0; k < kStrands; ++k) strands[k] += a[i + k];
  }
  for (; i < count; ++i) strands[0] += a[i];
  double total = 0.0;
  for (const double strand : strands) total += strand;
  return total;
}

template <typename Operation>
void SetUnary(KernelTable* table, ScalarOperation operation) {
  table->kernels[static_cast<int>(operation)][0] = &Loop<Operation, 1, 0>;
}

template <typename Operation>
void SetBinary(KernelTable* table, ScalarOperation operation) {
  Kernel* row = table->kernels[static_cast<int>(operation)];
  row[0] = &Loop<Operation, 2, 0>;
  row[1] = &Loop<Operation, 2, 1>;
  row[2] = &Loop<Operation, 2, 2>;
}

template <typename Operation>
void SetTernary(KernelTable* table, ScalarOperation operation) {
  Kernel* row = table->kernels[static_cast<int>(operation)];
  row[0] = &Loop<Operation, 3, 0>;
  row[1] = &Loop<Operation, 3, 1>;
  row[2] = &Loop<Operation, 3, 2>;
  row[3] = &Loop<Operation, 3, 3>;
  row[4] = &Loop<Operation, 3, 4>;
  row[5] = &Loop<Operation, 3, 5>;
  row[6] = &Loop<Operation, 3, 6>;
}

inline void SetUnaries(KernelTable* table) {
  using enum ScalarOperation;
  SetUnary<NegateOf>(table, kNegate);
  SetUnary<AbsoluteOf>(table, kAbsolute);
  SetUnary<SquareRootOf>(table, kSquareRoot);
  SetUnary<ExponentialOf>(table, kExponential);
  SetUnary<LogarithmOf>(table, kLogarithm);
  SetUnary<TangentOf>(table, kTangent);
  SetUnary<ArcSineOf>(table, kArcSine);
  SetUnary<ArcCosineOf>(table, kArcCosine);
  SetUnary<ArcTangentOf>(table, kArcTangent);
  SetUnary<HyperbolicTangentOf>(table, kHyperbolicTangent);
  SetUnary<SigmoidOf>(table, kSigmoid);
  SetUnary<FloorOf>(table, kFloor);
  SetUnary<CeilingOf>(table, kCeiling);
  SetUnary<RoundOf>(table, kRound);
  SetUnary<TruncateOf>(table, kTruncate);
  SetUnary<SignOf>(table, kSign);
  SetUnary<IsNanOf>(table, kIsNan);
  SetUnary<NotOf>(table, kNot);
  SetUnary<LogarithmOfOnePlusOf>(table, kLogarithmOfOnePlus);
  SetUnary<ExponentialMinusOneOf>(table, kExponentialMinusOne);
  table->kernels[static_cast<int>(kSine)][0] = &AngleLoop<SineOf, true>;
  table->kernels[static_cast<int>(kCosine)][0] = &AngleLoop<CosineOf, false>;
}

inline KernelTable MakeTable() {
  using enum ScalarOperation;
  KernelTable table = {};
  SetUnaries(&table);
  SetBinary<AddOf>(&table, kAdd);
  SetBinary<SubtractOf>(&table, kSubtract);
  SetBinary<MultiplyOf>(&table, kMultiply);
  SetBinary<DivideOf>(&table, kDivide);
  SetBinary<PowerOf>(&table, kPower);
  SetBinary<ArcTangent2Of>(&table, kArcTangent2);
  SetBinary<MinimumOf>(&table, kMinimum);
  SetBinary<MaximumOf>(&table, kMaximum);
  SetBinary<LessOf>(&table, kLess);
  SetBinary<LessEqualOf>(&table, kLessEqual);
  SetBinary<EqualOf>(&table, kEqual);
  SetBinary<NotEqualOf>(&table, kNotEqual);
  SetBinary<AndOf>(&table, kAnd);
  SetBinary<OrOf>(&table, kOr);
  SetBinary<TruncatedRemainderOf>(&table, kTruncatedRemainder);
  SetBinary<FloorRemainderOf>(&table, kFloorRemainder);
  SetBinary<FloorDivideOf>(&table, kFloorDivide);
  SetTernary<SelectOf>(&table, kSelect);
  SetTernary<MultiplyAddOf>(&table, kMultiplyAdd);
  SetTernary<MultiplySubtractOf>(&table, kMultiplySubtract);
  SetTernary<SquaredDifferenceAddOf>(&table, kSquaredDifferenceAdd);
  table.split_triples = &SplitTriples;
  table.store_flags = &StoreFlags;
  table.sum = &Sum;
  return table;
}

}  // namespace simwright::reward::SIMWRIGHT_KERNEL_ISA
