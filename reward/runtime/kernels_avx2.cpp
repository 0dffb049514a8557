// The kernels for processors with AVX2. All required headers precede the pragma: code shared with
// other files must not be compiled for these processors only.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "reward/runtime/kernels.h"

#if defined(__x86_64__)
#define SIMWRIGHT_KERNEL_ISA kernels_avx2
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#include "reward/runtime/kernel_loops.h"
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace simwright::reward {

const KernelTable& Avx2Kernels() {
#if defined(__x86_64__)
  static const KernelTable table = kernels_avx2::MakeTable();
  return table;
#else
  return PlainKernels();
#endif
}

}  // namespace simwright::reward
