// The kernels for any processor.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "reward/runtime/kernels.h"

#define SIMWRIGHT_KERNEL_ISA kernels_plain
#include "reward/runtime/kernel_loops.h"

namespace simwright::reward {

const KernelTable& PlainKernels() {
  static const KernelTable table = kernels_plain::MakeTable();
  return table;
}

}  // namespace simwright::reward
