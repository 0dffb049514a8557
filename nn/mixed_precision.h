#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// While it lives, products of matrices and convolutions on `device` are done in bfloat16
// (libtorch's autocast, this thread): a GPU does them several times as fast, weights and sums stay
// in single precision, and its range is the same, so that no loss has to be scaled. Keep it to a
// network's forward pass and its loss.
class MixedPrecision {
 public:
  // Does nothing where it is not `wanted`.
  MixedPrecision(const torch::Device& device, bool wanted);
  ~MixedPrecision();
  MixedPrecision(const MixedPrecision&) = delete;
  MixedPrecision& operator=(const MixedPrecision&) = delete;

 private:
  bool on_gpu_, wanted_, before_;
};

}  // namespace simwright::nn
