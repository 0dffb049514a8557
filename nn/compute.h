#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// CUDA where libtorch finds it, else the CPU.
torch::Device BestDevice();

// Gives libtorch core::ThreadCount() threads: it starts with one where two hyperthreads are one
// core. Call before heavy work.
void UseThreads();

// `parameter` count of a module, learned ones only.
std::int64_t ParameterCount(const torch::nn::Module& module);

}  // namespace simwright::nn
