#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// CUDA where libtorch finds it, else the CPU.
torch::Device BestDevice();

// Gives libtorch core::ThreadCount() threads: it starts with one where two hyperthreads are one
// core. Call before heavy work.
void UseThreads();

}  // namespace simwright::nn
