#include "nn/compute.h"

#include "core/parallel.h"

namespace simwright::nn {

torch::Device BestDevice() {
  return torch::Device(torch::cuda::is_available() ? torch::kCUDA : torch::kCPU);
}

void UseThreads() {
  at::set_num_threads(core::ThreadCount());
}

}  // namespace simwright::nn
