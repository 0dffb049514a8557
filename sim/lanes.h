#pragma once

namespace simwright::sim {

// Generalized vectors are padded with zeros to a multiple of this.
constexpr int kLanes = 4;

// Four numbers at once: one AVX register, or two of SSE. Sums have the same order in both, and
// products and sums are not contracted, so that results do not depend on the processor.
// The attributes precede the type, since Clang ignores `aligned` behind it.
using Lanes __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias)) = double;
static_assert(alignof(Lanes) == alignof(double), "rows of numbers start at any double");

// Returns the scalar product of two vectors of `count` numbers.
__attribute__((always_inline)) inline double Product(const double* jacobian, const double* velocity,
                                                     int count) {
  Lanes sum = {};
  for (int i = 0; i < count; i += kLanes) {
    sum += *reinterpret_cast<const Lanes*>(jacobian + i) *
           *reinterpret_cast<const Lanes*>(velocity + i);
  }
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

// Adds `share` times a vector of `count` numbers to `sum`.
__attribute__((always_inline)) inline void AddScaled(double share, const double* values, int count,
                                                     double* sum) {
  for (int i = 0; i < count; i += kLanes) {
    *reinterpret_cast<Lanes*>(sum + i) += share * *reinterpret_cast<const Lanes*>(values + i);
  }
}

}  // namespace simwright::sim
