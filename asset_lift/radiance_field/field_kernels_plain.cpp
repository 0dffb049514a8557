// The field's inner loops for any x86-64 (or other) processor.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "asset_lift/radiance_field/field_model.h"

#define SIMWRIGHT_FIELD_ISA field_plain
// A square root that sets errno for negative numbers is a call, which is not vectorised.
#if !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("no-math-errno")
#endif
#include "asset_lift/radiance_field/field_kernels.h"
#if !defined(__clang__)
#pragma GCC pop_options
#endif

namespace simwright::asset_lift {

template <typename Real>
FieldKernels<Real> PlainFieldKernels() {
  return {&field_plain::EvaluateBatch<Real>, &field_plain::AddBatchGradient<Real>,
          &field_plain::AccumulatePart<Real>, &field_plain::Adam<Real>};
}

template FieldKernels<float> PlainFieldKernels();
template FieldKernels<double> PlainFieldKernels();

}  // namespace simwright::asset_lift
