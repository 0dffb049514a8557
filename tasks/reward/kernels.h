#pragma once

#include <cstdint>

#include "tasks/reward/scalar_operation.h"

namespace simwright::tasks::reward {

// result[i] = operation(a[i], b[i], c[i]) for i < count; result overlaps no operand.
using Kernel = void (*)(float* result, const float* a, const float* b, const float* c, int count);

// The loops of one instruction set. The second index has a bit an operand (1: a, 2: b, 4: c) that
// is set where it is one number for all environments; null where no program can ask for it.
struct KernelTable {
  Kernel kernels[kScalarOperations][8];
  // columns[k][i] = rows[3 i + k]: turns [count, 3] into three columns.
  void (*split_triples)(const float* rows, float* const columns[3], int count);
  // flags[i] = a[i] != 0.
  void (*store_flags)(std::uint8_t* flags, const float* a, int count);
  // The sum of a[0 .. count), in double.
  double (*sum)(const float* a, int count);
};

// The table of the best instructions that this processor has. All tables give the same numbers.
const KernelTable& Kernels();

// One operation on plain numbers, as the kernels do it.
float EvaluateScalar(ScalarOperation operation, float a, float b, float c);

const KernelTable& PlainKernels();
const KernelTable& Avx2Kernels();
const KernelTable& Avx512Kernels();

}  // namespace simwright::tasks::reward
