#pragma once

#include <cstdint>

#include "reward/ir/scalar_operation.h"

namespace simwright::reward {

// Computes result[i] = operation(a[i], b[i], c[i]) for i < count; `result` must not overlap an
// operand.
using Kernel = void (*)(float* result, const float* a, const float* b, const float* c, int count);

// The loops of one instruction set. The second index has one bit per operand (1: a, 2: b, 4: c),
// which is set if the operand is one number for all environments. Entries that no program can
// request are null.
struct KernelTable {
  Kernel kernels[kScalarOperations][8];
  // Computes columns[k][i] = rows[3 i + k]: transposes [count, 3] into three columns.
  void (*split_triples)(const float* rows, float* const columns[3], int count);
  // Computes flags[i] = a[i] != 0.
  void (*store_flags)(std::uint8_t* flags, const float* a, int count);
  // Returns the sum of a[0 .. count), in double.
  double (*sum)(const float* a, int count);
};

// Returns the table for the best instruction set of this processor. All tables give the same
// numbers.
const KernelTable& Kernels();

// Evaluates one operation on plain numbers with the kernels' semantics.
float EvaluateScalar(ScalarOperation operation, float a, float b, float c);

const KernelTable& PlainKernels();
const KernelTable& Avx2Kernels();
const KernelTable& Avx512Kernels();

}  // namespace simwright::reward
