#pragma once

#include <cstddef>

#include "asset_lift/radiance_field/hash_grid.h"
#include "asset_lift/radiance_field/radiance_field.h"

// The radiance field as its inner loops see it, and the loops themselves, compiled once for AVX2
// with FMA and once for plain x86-64 (field_kernels.h).
namespace simwright::asset_lift {

inline constexpr int kFieldOutputs = 4;  // density, red, green, blue
inline constexpr int kMaxFieldHidden = 128;
inline constexpr int kBiasCells = 64;  // per side of a tabulated bias

// The term added to the density before its softplus.
template <typename Real>
struct FieldBias {
  Real blob_scale = 0, blob_slope = 0;  // scale - slope * distance from the centre
  const Real* table = nullptr;          // replaces the blob: (kBiasCells + 1)^3, x fastest
};

template <typename Real>
struct FieldModel {
  const HashGridLayout* layout = nullptr;
  int inputs = 0, hidden = 0;
  const Real* table = nullptr;
  const Real* hidden_weights = nullptr;  // (inputs x hidden), after the table
  const Real* output_weights = nullptr;  // (kFieldOutputs x hidden), after the hidden weights
  Real density_scale = 1;
  FieldBias<Real> bias;
};

// The factors of one step x -= rate m / (root_scale sqrt(v) + epsilon).
template <typename Real>
struct AdamStep {
  Real beta1, beta2, rate, root_scale, epsilon;
};

template <typename Real>
struct FieldKernels {
  // Fills all fields of `batch` except its positions.
  void (*evaluate)(const FieldModel<Real>& model, FieldBatch<Real>* batch);
  // Adds the parameters' gradients to `sum`, which has the same layout as the parameters.
  void (*add_gradient)(const FieldModel<Real>& model, const FieldBatch<Real>& batch,
                       const FieldBatchGradient<Real>& gradient, Real* sum);
  // Adds `part` to `sum` and zeroes `part`, over `count` numbers. Returns false if a sum is not
  // finite.
  bool (*accumulate_part)(std::size_t count, Real* part, Real* sum);
  // Takes a step of Adam; `gradient` becomes zero.
  void (*adam)(const AdamStep<Real>& step, std::size_t count, Real* gradient, Real* mean,
               Real* square, Real* parameters);
};

// `Real` is float or double. FastestFieldKernels returns the kernels that run fastest on this
// processor.
template <typename Real>
const FieldKernels<Real>& FastestFieldKernels();
template <typename Real>
FieldKernels<Real> PlainFieldKernels();
template <typename Real>
FieldKernels<Real> Avx2FieldKernels();  // the plain kernels on other processor families

}  // namespace simwright::asset_lift
