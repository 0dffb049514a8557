#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// CUDA where libtorch finds it, else the CPU.
torch::Device BestDevice();

// Gives libtorch core::ThreadCount() threads (it starts with one where two hyperthreads are one
// core), and keeps for it the memory that a step frees. Call before heavy work.
void PrepareForWork();

}  // namespace simwright::nn
