#include "nn/mixed_precision.h"

#include <ATen/autocast_mode.h>

namespace simwright::nn {

MixedPrecision::MixedPrecision(const torch::Device& device, bool wanted)
    : on_gpu_(device.is_cuda()),
      wanted_(wanted),
      before_(on_gpu_ ? at::autocast::is_enabled() : at::autocast::is_cpu_enabled()) {
  if (!wanted_) return;
  if (on_gpu_) {
    at::autocast::set_autocast_gpu_dtype(torch::kBFloat16);
    at::autocast::set_enabled(true);
  } else {
    at::autocast::set_autocast_cpu_dtype(torch::kBFloat16);
    at::autocast::set_cpu_enabled(true);
  }
}

MixedPrecision::~MixedPrecision() {
  if (!wanted_) return;
  // The cache of half-precision weights must not outlive their next update.
  at::autocast::clear_cache();
  on_gpu_ ? at::autocast::set_enabled(before_) : at::autocast::set_cpu_enabled(before_);
}

}  // namespace simwright::nn
