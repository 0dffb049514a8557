#pragma once

// The radiance field's inner loops over one batch of points, compiled for the instruction set whose
// namespace SIMWRIGHT_FIELD_ISA names (field_kernels_avx2.cpp, field_kernels_plain.cpp). All loops
// run over contiguous numbers, which the compiler vectorises; the matrix products use explicit
// vector registers, because the compiler does not vectorise them by itself. Template arguments of 0
// stand for sizes known at run time only.
namespace simwright::asset_lift::SIMWRIGHT_FIELD_ISA {

// Returns e^x with a relative error below 2e-7 for floats; x is clamped to [-87, 88]. Doubles use
// std::exp.
template <typename Real>
inline Real Exp(Real x) {
  if constexpr (std::is_same_v<Real, float>) {
    x = x < -87.0f ? -87.0f : x;
    x = x > 88.0f ? 88.0f : x;
    const float turns = x * 1.44269504f;
    const auto n = static_cast<std::int32_t>(turns + (turns < 0.0f ? -0.5f : 0.5f));
    const auto whole = static_cast<float>(n);
    // ln 2 is split in two parts to keep the remainder's digits; its Taylor series follows.
    const float r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f;
    const float p =
        1.0f +
        r * (1.0f +
             r * (0.5f + r * (1.66666667e-1f +
                              r * (4.16666667e-2f + r * (8.33333333e-3f + r * 1.38888889e-3f)))));
    return p * std::bit_cast<float>((n + 127) << 23);
  } else {
    return std::exp(x);
  }
}

// Returns log(1 + u) for u in [0, 1], within 1e-7: 2 artanh(u / (2 + u)) by its series.
template <typename Real>
inline Real Log1p(Real u) {
  if constexpr (std::is_same_v<Real, float>) {
    const float s = u / (2.0f + u);
    const float q = s * s;
    return 2.0f * s *
           (1.0f +
            q * (1.0f / 3 +
                 q * (1.0f / 5 + q * (1.0f / 7 + q * (1.0f / 9 + q * (1.0f / 11 + q / 13))))));
  } else {
    return std::log1p(u);
  }
}

// Returns log(1 + e^x). Its derivative is 1 - e^-Softplus(x).
template <typename Real>
inline Real Softplus(Real x) {
  const Real size = x < 0 ? -x : x;
  return (x < 0 ? Real(0) : x) + Log1p(Exp(-size));
}

template <typename Real>
struct RegisterOf {
  typedef Real Type __attribute__((vector_size(32)));
};

// The intermediate results of a pass over a batch, one row per point.
template <typename Real>
struct Scratch {
  alignas(64) std::uint32_t index[8][kFieldBatch];  // the table entries of a cell's corners
  alignas(64) Real weight[8][kFieldBatch];
  alignas(64) Real unit[3][kFieldBatch];  // positions in [0, 1]
  alignas(64) Real hidden[kFieldBatch * kMaxFieldHidden];
  alignas(64) Real outputs[kFieldBatch * 8];  // or their gradients; four of eight are used
  alignas(64) Real hidden_gradient[kFieldBatch * kMaxFieldHidden];
  alignas(64) Real feature_gradient[kFieldBatch * kMaxFieldInputs];
  alignas(64) Real transposed_weights[kMaxFieldHidden * kMaxFieldInputs];
};

// Computes c = a b, or c += a b, for kRows rows of a and c and kRegisters * lanes columns of b and
// c. `a_row` and `a_inner` are the strides between rows and between columns of a; `stride` is that
// between rows of b and c.
template <int kRows, int kRegisters, typename Real>
inline void MultiplyTile(int inner, const Real* a, int a_row, int a_inner, const Real* b,
                         int stride, bool add, Real* c) {
  using Register = typename RegisterOf<Real>::Type;
  constexpr int kLanes = sizeof(Register) / sizeof(Real);
  Register sum[kRows][kRegisters];
#pragma GCC unroll 8
  for (int r = 0; r < kRows; ++r) {
#pragma GCC unroll 8
    for (int v = 0; v < kRegisters; ++v) {
      sum[r][v] = Register{};
      if (add) std::memcpy(&sum[r][v], c + r * stride + v * kLanes, sizeof(Register));
    }
  }
  for (int k = 0; k < inner; ++k) {
#pragma GCC unroll 8
    for (int v = 0; v < kRegisters; ++v) {
      Register row;
      std::memcpy(&row, b + k * stride + v * kLanes, sizeof(Register));
#pragma GCC unroll 8
      for (int r = 0; r < kRows; ++r) sum[r][v] += a[r * a_row + k * a_inner] * row;
    }
  }
#pragma GCC unroll 8
  for (int r = 0; r < kRows; ++r) {
#pragma GCC unroll 8
    for (int v = 0; v < kRegisters; ++v) {
      std::memcpy(c + r * stride + v * kLanes, &sum[r][v], sizeof(Register));
    }
  }
}

// Multiplies all columns of kRows rows.
template <int kRows, typename Real>
inline void MultiplyRows(int inner, int columns, const Real* a, int a_row, int a_inner,
                         const Real* b, bool add, Real* c) {
  constexpr int kLanes = 32 / sizeof(Real);
  constexpr int kRegisters = 8 / kRows;
  int j = 0;
  for (; j + kRegisters * kLanes <= columns; j += kRegisters * kLanes) {
    MultiplyTile<kRows, kRegisters>(inner, a, a_row, a_inner, b + j, columns, add, c + j);
  }
  for (; j < columns; j += kLanes) {
    MultiplyTile<kRows, 1>(inner, a, a_row, a_inner, b + j, columns, add, c + j);
  }
}

// Computes c = a b, or c += a b. a is (rows x inner) with row stride `a_stride`, or (inner x rows)
// where `transposed`; b is (inner x columns) and c (rows x columns). `columns` is a multiple of 8.
// Eight sums are kept in registers, which hides the latency of their additions.
template <typename Real>
inline void Multiply(int rows, int inner, int columns, const Real* a, int a_stride, bool transposed,
                     const Real* b, bool add, Real* c) {
  const int a_row = transposed ? 1 : a_stride;
  const int a_inner = transposed ? a_stride : 1;
  const bool wide = columns * sizeof(Real) >= 4 * 32;
  const int tile = wide ? 2 : 4;
  for (int t = 0; t < rows / tile; ++t) {
    if (wide) {
      MultiplyRows<2>(inner, columns, a, a_row, a_inner, b, add, c);
    } else {
      MultiplyRows<4>(inner, columns, a, a_row, a_inner, b, add, c);
    }
    a += tile * a_row;
    c += tile * columns;
  }
  const int rest = rows % tile;
  if (rest & 2) MultiplyRows<2>(inner, columns, a, a_row, a_inner, b, add, c);
  if (rest & 1) {
    const int last = rest - 1;
    MultiplyRows<1>(inner, columns, a + last * a_row, a_row, a_inner, b, add, c + last * columns);
  }
}

template <typename Real>
inline void UnitPositions(const FieldBatch<Real>& batch, Scratch<Real>* scratch) {
  for (int a = 0; a < 3; ++a) {
    for (int s = 0; s < kFieldBatch; ++s) {
      const Real u = Real(0.5) * batch.position[a][s] + Real(0.5);
      scratch->unit[a][s] = u > Real(0) ? (u < Real(1) ? u : Real(1)) : Real(0);
    }
  }
}

// Computes each point's cell, the table entries of its corners and their trilinear weights.
template <typename Real>
inline void Corners(const HashGridLevel& level, Scratch<Real>* scratch) {
  const Real cells = static_cast<Real>(level.cells);
  const std::int32_t last = level.cells - 1;
  const bool hashed = level.hashed();
  const std::uint32_t step[3] = {1, hashed ? 2654435761u : level.row,
                                 hashed ? 805459861u : level.slice};
  // Per axis, the index offsets and the weights of the lower and the upper corner.
  alignas(64) std::uint32_t offset[3][2][kFieldBatch];
  alignas(64) Real share[3][2][kFieldBatch];
  for (int a = 0; a < 3; ++a) {
    for (int s = 0; s < kFieldBatch; ++s) {
      const Real at = scratch->unit[a][s] * cells;
      std::int32_t i = static_cast<std::int32_t>(at);
      i = i < last ? i : last;
      const Real upper = at - static_cast<Real>(i);
      offset[a][0][s] = static_cast<std::uint32_t>(i) * step[a];
      offset[a][1][s] = static_cast<std::uint32_t>(i) * step[a] + step[a];
      share[a][0][s] = Real(1) - upper;
      share[a][1][s] = upper;
    }
  }
  for (int c = 0; c < 8; ++c) {
    const std::uint32_t* x = offset[0][c & 1];
    const std::uint32_t* y = offset[1][(c >> 1) & 1];
    const std::uint32_t* z = offset[2][c >> 2];
    if (hashed) {
      for (int s = 0; s < kFieldBatch; ++s) {
        scratch->index[c][s] = (x[s] ^ y[s] ^ z[s]) & level.mask;
      }
    } else {
      for (int s = 0; s < kFieldBatch; ++s) scratch->index[c][s] = x[s] + y[s] + z[s];
    }
    const Real* wx = share[0][c & 1];
    const Real* wy = share[1][(c >> 1) & 1];
    const Real* wz = share[2][c >> 2];
    for (int s = 0; s < kFieldBatch; ++s) scratch->weight[c][s] = wx[s] * wy[s] * wz[s];
  }
}

// Computes the features of a batch, (points x stride).
template <typename Real, int kFeatures>
inline void Encode(const HashGridLayout& layout, int stride, const Real* table,
                   Scratch<Real>* scratch, Real* features) {
  typedef Real Entry __attribute__((vector_size(kFeatures * sizeof(Real))));
  int first = 0;
  for (const HashGridLevel& level : layout.levels()) {
    Corners(level, scratch);
    const Real* entries = table + static_cast<std::size_t>(level.offset) * kFeatures;
    for (int s = 0; s < kFieldBatch; ++s) {
      Entry sum = {};
#pragma GCC unroll 8
      for (int c = 0; c < 8; ++c) {
        Entry entry;
        std::memcpy(&entry, entries + std::size_t{scratch->index[c][s]} * kFeatures, sizeof(Entry));
        sum += scratch->weight[c][s] * entry;
      }
      std::memcpy(features + s * stride + first, &sum, sizeof(Entry));
    }
    first += kFeatures;
  }
}

// Adds feature gradients to the table entries they came from, as the transpose of Encode. The loop
// takes points eight apart: neighbours share a cell, and each would wait for the store of the one
// before.
template <typename Real, int kFeatures>
inline void Scatter(const HashGridLayout& layout, int stride, Scratch<Real>* scratch, Real* table) {
  typedef Real Entry __attribute__((vector_size(kFeatures * sizeof(Real))));
  int first = 0;
  for (const HashGridLevel& level : layout.levels()) {
    Corners(level, scratch);
    Real* entries = table + static_cast<std::size_t>(level.offset) * kFeatures;
    for (int n = 0; n < kFieldBatch; ++n) {
      const int s = (n % 8) * 8 + n / 8;
      Entry gradient;
      std::memcpy(&gradient, scratch->feature_gradient + s * stride + first, sizeof(Entry));
#pragma GCC unroll 8
      for (int c = 0; c < 8; ++c) {
        Real* at = entries + std::size_t{scratch->index[c][s]} * kFeatures;
        Entry entry;
        std::memcpy(&entry, at, sizeof(Entry));
        entry += scratch->weight[c][s] * gradient;
        std::memcpy(at, &entry, sizeof(Entry));
      }
    }
    first += kFeatures;
  }
}

// Adds the density bias, a blob or a trilinearly interpolated table, to batch->raw.
template <typename Real>
inline void AddBias(const FieldBias<Real>& bias, Scratch<Real>* scratch, FieldBatch<Real>* batch) {
  if (bias.table == nullptr) {
    for (int s = 0; s < kFieldBatch; ++s) {
      const Real x = batch->position[0][s], y = batch->position[1][s], z = batch->position[2][s];
      batch->raw[s] += bias.blob_scale - bias.blob_slope * std::sqrt(x * x + y * y + z * z);
    }
    return;
  }
  HashGridLevel level;
  level.cells = kBiasCells;
  level.row = kBiasCells + 1;
  level.slice = level.row * level.row;
  Corners(level, scratch);
  for (int s = 0; s < kFieldBatch; ++s) {
    Real sum = 0;
    for (int c = 0; c < 8; ++c) sum += scratch->weight[c][s] * bias.table[scratch->index[c][s]];
    batch->raw[s] += sum;
  }
}

// The sizes of a field, constant where the template gives them.
template <int kInputs, int kHidden, int kFeatures>
struct Sizes {
  int inputs, hidden;
  int stride;  // inputs, rounded up to a multiple of 8
  template <typename Real>
  explicit Sizes(const FieldModel<Real>& model)
      : inputs(kInputs ? kInputs : model.inputs),
        hidden(kHidden ? kHidden : model.hidden),
        stride((inputs + 7) / 8 * 8) {}
  static constexpr int kPerEntry = kFeatures;
};

// Computes the hidden units of a batch from its features.
template <typename Shape, typename Real>
inline void ToHidden(const FieldModel<Real>& model, const Shape& shape,
                     const FieldBatch<Real>& batch, Scratch<Real>* scratch) {
  Multiply(kFieldBatch, shape.inputs, shape.hidden, batch.features, shape.stride, false,
           model.hidden_weights, false, scratch->hidden);
  for (int k = 0; k < kFieldBatch * shape.hidden; ++k) {
    scratch->hidden[k] = scratch->hidden[k] > Real(0) ? scratch->hidden[k] : Real(0);
  }
}

template <typename Shape, typename Real>
inline void Evaluate(const FieldModel<Real>& model, FieldBatch<Real>* batch) {
  const Shape shape(model);
  Scratch<Real> scratch;
  UnitPositions(*batch, &scratch);
  Encode<Real, Shape::kPerEntry>(*model.layout, shape.stride, model.table, &scratch,
                                 batch->features);
  ToHidden(model, shape, *batch, &scratch);
  Real* weights = scratch.transposed_weights;  // (hidden x 8)
  for (int j = 0; j < shape.hidden; ++j) {
    for (int o = 0; o < 8; ++o) {
      weights[j * 8 + o] = o < kFieldOutputs ? model.output_weights[o * shape.hidden + j] : Real(0);
    }
  }
  Multiply(kFieldBatch, shape.hidden, 8, scratch.hidden, shape.hidden, false, weights, false,
           scratch.outputs);
  for (int s = 0; s < kFieldBatch; ++s) {
    batch->raw[s] = scratch.outputs[s * 8];
    for (int c = 0; c < 3; ++c) batch->color[c][s] = scratch.outputs[s * 8 + 1 + c];
  }
  AddBias(model.bias, &scratch, batch);
  const Real scale = model.density_scale;
  for (int s = 0; s < kFieldBatch; ++s) batch->density[s] = scale * Softplus(batch->raw[s]);
  for (int c = 0; c < 3; ++c) {
    for (int s = 0; s < kFieldBatch; ++s) {
      batch->color[c][s] = Real(1) / (Real(1) + Exp(-batch->color[c][s]));
    }
  }
}

// Computes the gradients before the activations, (points x kFieldOutputs).
template <typename Real>
inline void OutputGradient(const FieldModel<Real>& model, const FieldBatch<Real>& batch,
                           const FieldBatchGradient<Real>& gradient, Real* outputs) {
  const Real scale = model.density_scale, inverse = Real(1) / scale;
  for (int s = 0; s < kFieldBatch; ++s) {
    const Real slope = scale * (Real(1) - Exp(-inverse * batch.density[s]));
    outputs[s * kFieldOutputs] = gradient.raw[s] + gradient.density[s] * slope;
    for (int c = 0; c < 3; ++c) {
      const Real color = batch.color[c][s];
      outputs[s * kFieldOutputs + 1 + c] = gradient.color[c][s] * color * (Real(1) - color);
    }
  }
}

// Computes the backward pass of Evaluate.
template <typename Shape, typename Real>
inline void AddGradient(const FieldModel<Real>& model, const FieldBatch<Real>& batch,
                        const FieldBatchGradient<Real>& gradient, Real* sum) {
  const Shape shape(model);
  const int inputs = shape.inputs, hidden = shape.hidden, stride = shape.stride;
  Scratch<Real> scratch;
  ToHidden(model, shape, batch, &scratch);
  OutputGradient(model, batch, gradient, scratch.outputs);
  Real* hidden_sum = sum + (model.hidden_weights - model.table);
  Real* output_sum = sum + (model.output_weights - model.table);
  Multiply(kFieldOutputs, kFieldBatch, hidden, scratch.outputs, kFieldOutputs, true, scratch.hidden,
           true, output_sum);
  Multiply(kFieldBatch, kFieldOutputs, hidden, scratch.outputs, kFieldOutputs, false,
           model.output_weights, false, scratch.hidden_gradient);
  for (int k = 0; k < kFieldBatch * hidden; ++k) {
    scratch.hidden_gradient[k] = scratch.hidden[k] > Real(0) ? scratch.hidden_gradient[k] : Real(0);
  }
  Multiply(inputs, kFieldBatch, hidden, batch.features, stride, true, scratch.hidden_gradient, true,
           hidden_sum);
  Real* weights = scratch.transposed_weights;  // (hidden x stride)
  for (int i = 0; i < stride; ++i) {
    for (int j = 0; j < hidden; ++j) {
      weights[j * stride + i] = i < inputs ? model.hidden_weights[i * hidden + j] : Real(0);
    }
  }
  Multiply(kFieldBatch, hidden, stride, scratch.hidden_gradient, hidden, false, weights, false,
           scratch.feature_gradient);
  UnitPositions(batch, &scratch);
  Scatter<Real, Shape::kPerEntry>(*model.layout, stride, &scratch, sum);
}

template <typename Real>
bool AccumulatePart(std::size_t count, Real* part, Real* sum) {
  // Zero times a number is zero unless the number is not finite.
  Real check[8] = {};
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    for (int k = 0; k < 8; ++k) {
      sum[i + k] += part[i + k];
      part[i + k] = 0;
      check[k] += Real(0) * sum[i + k];
    }
  }
  for (; i < count; ++i) {
    sum[i] += part[i];
    part[i] = 0;
    check[0] += Real(0) * sum[i];
  }
  bool finite = true;
  for (const Real c : check) finite = finite && c == Real(0);
  return finite;
}

template <typename Real>
void Adam(const AdamStep<Real>& step, std::size_t count, Real* __restrict gradient,
          Real* __restrict mean, Real* __restrict square, Real* __restrict parameters) {
  for (std::size_t i = 0; i < count; ++i) {
    const Real g = gradient[i];
    const Real m = step.beta1 * mean[i] + (Real(1) - step.beta1) * g;
    const Real v = step.beta2 * square[i] + (Real(1) - step.beta2) * g * g;
    parameters[i] -= step.rate * m / (step.root_scale * std::sqrt(v) + step.epsilon);
    mean[i] = m;
    square[i] = v;
    gradient[i] = 0;
  }
}

// Evaluates a batch. The default field's sizes are compile-time constants; other sizes use the
// general code.
template <typename Real>
void EvaluateBatch(const FieldModel<Real>& model, FieldBatch<Real>* batch) {
  switch (model.layout->features()) {
    case 1:
      return Evaluate<Sizes<0, 0, 1>>(model, batch);
    case 4:
      return Evaluate<Sizes<0, 0, 4>>(model, batch);
    default:
      break;
  }
  if (model.inputs == 16 && model.hidden == 32) return Evaluate<Sizes<16, 32, 2>>(model, batch);
  return Evaluate<Sizes<0, 0, 2>>(model, batch);
}

template <typename Real>
void AddBatchGradient(const FieldModel<Real>& model, const FieldBatch<Real>& batch,
                      const FieldBatchGradient<Real>& gradient, Real* sum) {
  switch (model.layout->features()) {
    case 1:
      return AddGradient<Sizes<0, 0, 1>>(model, batch, gradient, sum);
    case 4:
      return AddGradient<Sizes<0, 0, 4>>(model, batch, gradient, sum);
    default:
      break;
  }
  if (model.inputs == 16 && model.hidden == 32) {
    return AddGradient<Sizes<16, 32, 2>>(model, batch, gradient, sum);
  }
  return AddGradient<Sizes<0, 0, 2>>(model, batch, gradient, sum);
}

}  // namespace simwright::asset_lift::SIMWRIGHT_FIELD_ISA
