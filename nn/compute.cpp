#include "nn/compute.h"

#include <malloc.h>

#include "core/parallel.h"

namespace simwright::nn {

torch::Device BestDevice() {
  return torch::Device(torch::cuda::is_available() ? torch::kCUDA : torch::kCPU);
}

void PrepareForWork() {
  at::set_num_threads(core::ThreadCount());
  // A step's tensors, some tens of MB, are freed at its end and wanted again by the next. glibc
  // hands them back to the system in between: a seventh of a training on one core was page faults.
  constexpr int kKept = 1 << 30, kGrowth = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kGrowth);
}

}  // namespace simwright::nn
