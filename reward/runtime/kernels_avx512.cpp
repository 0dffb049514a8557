// The kernels for processors with AVX-512. All required headers precede the pragma: code shared
// with other files must not be compiled for these processors only.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "reward/runtime/kernels.h"

#if defined(__x86_64__)
#define SIMWRIGHT_KERNEL_ISA kernels_avx512
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"))), \
                             apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw,prefer-vector-width=512")
#endif
#include "reward/runtime/kernel_loops.h"
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace simwright::reward {

const KernelTable& Avx512Kernels() {
#if defined(__x86_64__)
  static const KernelTable table = kernels_avx512::MakeTable();
  return table;
#else
  return PlainKernels();
#endif
}

}  // namespace simwright::reward
