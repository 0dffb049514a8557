#include "nn/noise.h"

#include <mutex>

namespace simwright::nn {
namespace {

torch::TensorOptions OptionsOf(const at::Generator& generator) {
  return torch::TensorOptions(torch::kFloat).device(generator.device());
}

}  // namespace

at::Generator SeededGenerator(std::uint64_t seed, const torch::Device& device, bool on_device) {
  if (!on_device || device.is_cpu()) return at::detail::createCPUGenerator(seed);
  // The default generator's copy is one of the same device, without a header of CUDA.
  at::Generator shared = at::globalContext().defaultGenerator(device);
  at::Generator own = [&] {
    const std::lock_guard lock(shared.mutex());
    return shared.clone();
  }();
  own.set_current_seed(seed);
  return own;
}

torch::Tensor NormalNumbers(at::IntArrayRef sizes, const at::Generator& generator) {
  return torch::randn(sizes, generator, OptionsOf(generator));
}

torch::Tensor UniformNumbers(at::IntArrayRef sizes, const at::Generator& generator) {
  return torch::rand(sizes, generator, OptionsOf(generator));
}

}  // namespace simwright::nn
