#pragma once

#include "core/lanes.h"

namespace simwright::sim {

using core::kLanes;  // generalized vectors are padded with zeros to a multiple of this
using core::Lanes;

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
