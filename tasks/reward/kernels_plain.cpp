// The kernels for any processor.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "tasks/reward/kernels.h"

#define SIMWRIGHT_KERNEL_ISA kernels_plain
#include "tasks/reward/kernel_loops.h"

namespace simwright::tasks::reward {

const KernelTable& PlainKernels() {
  static const KernelTable table = kernels_plain::MakeTable();
  return table;
}

}  // namespace simwright::tasks::reward
