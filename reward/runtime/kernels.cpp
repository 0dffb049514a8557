#include "reward/runtime/kernels.h"

namespace simwright::reward {

const KernelTable& Kernels() {
#if defined(__x86_64__)
  static const KernelTable& best = [&]() -> const KernelTable& {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
      return Avx512Kernels();
    }
    return __builtin_cpu_supports("avx2") ? Avx2Kernels() : PlainKernels();
  }();
  return best;
#else
  return PlainKernels();
#endif
}

float EvaluateScalar(ScalarOperation operation, float a, float b, float c) {
  float result = 0.0f;
  PlainKernels().kernels[static_cast<int>(operation)][0](&result, &a, &b, &c, 1);
  return result;
}

}  // namespace simwright::reward
