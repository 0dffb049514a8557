#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// A scope guard that runs matrix products and convolutions on `device` in bfloat16 (libtorch's
// autocast, this thread). A GPU does them several times as fast; weights and sums stay in single
// precision, and bfloat16 has the same range, so the loss needs no scaling. Use it around a
// network's forward pass and its loss only.
class MixedPrecision {
 public:
  // Does nothing unless `wanted`.
  MixedPrecision(const torch::Device& device, bool wanted);
  ~MixedPrecision();
  MixedPrecision(const MixedPrecision&) = delete;
  MixedPrecision& operator=(const MixedPrecision&) = delete;

 private:
  bool on_gpu_, wanted_, before_;
};

}  // namespace simwright::nn
