// The field's inner loops for processors with AVX2 and FMA. All headers that they need are included
// before the target pragma: code shared with other files must not be compiled for AVX2.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "asset_lift/radiance_field/field_model.h"

#if defined(__x86_64__)
#define SIMWRIGHT_FIELD_ISA field_avx2
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#pragma clang fp contract(fast)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#pragma GCC optimize("fp-contract=fast", "no-math-errno")
#endif
#include "asset_lift/radiance_field/field_kernels.h"
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace simwright::asset_lift {

template <typename Real>
FieldKernels<Real> Avx2FieldKernels() {
#if defined(__x86_64__)
  return {&field_avx2::EvaluateBatch<Real>, &field_avx2::AddBatchGradient<Real>,
          &field_avx2::AccumulatePart<Real>, &field_avx2::Adam<Real>};
#else
  return PlainFieldKernels<Real>();
#endif
}

template FieldKernels<float> Avx2FieldKernels();
template FieldKernels<double> Avx2FieldKernels();

}  // namespace simwright::asset_lift
