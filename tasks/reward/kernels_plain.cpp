// The kernels for any processor.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "tasks/reward/kernels.h"

#define SIMWRIGHT_KERNEL_ISA kernels_plain
// Without these a square root or a choice between two numbers is no vector code.
#if !defined(__clang__)
#pragma GCC push_options
#pragma GCC optimize("no-math-errno", "no-trapping-math")
#endif
#include "tasks/reward/kernel_loops.h"
#if !defined(__clang__)
#pragma GCC pop_options
#endif

namespace simwright::tasks::reward {

const KernelTable& PlainKernels() {
  static const KernelTable table = kernels_plain::MakeTable();
  return table;
}

}  // namespace simwright::tasks::reward
