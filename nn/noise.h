#pragma once

#include <cstdint>

#include "nn/torch.h"

namespace simwright::nn {

// Returns a generator of random numbers, independent of libtorch's default ones. By default it
// draws on the CPU, so that a seed gives the same numbers on every device; `on_device`: on
// `device`, which saves the copies and gives other numbers than the CPU.
at::Generator SeededGenerator(std::uint64_t seed, const torch::Device& device, bool on_device);

// Return single-precision numbers on the generator's device: standard normal, and uniform in
// [0, 1).
torch::Tensor NormalNumbers(at::IntArrayRef sizes, const at::Generator& generator);
torch::Tensor UniformNumbers(at::IntArrayRef sizes, const at::Generator& generator);

}  // namespace simwright::nn
