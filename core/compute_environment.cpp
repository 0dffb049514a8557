#include "core/compute_environment.h"

#include <stdlib.h>
#include <unistd.h>

#include <cstdlib>

namespace simwright::core {

void RestartWithComputeEnvironment(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
    setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
  }
#endif
  execv("/proc/self/exe", argv);
}

}  // namespace simwright::core
