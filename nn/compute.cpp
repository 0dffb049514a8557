#include "nn/compute.h"

#include "core/parallel.h"

namespace simwright::nn {

torch::Device BestDevice() {
  return torch::Device(torch::cuda::is_available() ? torch::kCUDA : torch::kCPU);
}

void UseThreads() {
  at::set_num_threads(core::ThreadCount());
}

std::int64_t ParameterCount(const torch::nn::Module& module) {
  std::int64_t count = 0;
  for (const torch::Tensor& parameter : module.parameters()) count += parameter.numel();
  return count;
}

}  // namespace simwright::nn
