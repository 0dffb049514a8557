#include "nn/mixed_precision.h"

#include <ATen/autocast_mode.h>
#include <torch/version.h>

namespace simwright::nn {
namespace {

// libtorch 2.4 replaces the functions per device by one for all, and warns at each call of the old
// ones.
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
bool AutocastIsOn(bool on_gpu) {
  return at::autocast::is_autocast_enabled(on_gpu ? at::kCUDA : at::kCPU);
}

void SetAutocast(bool on_gpu, bool on) {
  const at::DeviceType device = on_gpu ? at::kCUDA : at::kCPU;
  if (on) at::autocast::set_autocast_dtype(device, torch::kBFloat16);
  at::autocast::set_autocast_enabled(device, on);
}
#else
bool AutocastIsOn(bool on_gpu) {
  return on_gpu ? at::autocast::is_enabled() : at::autocast::is_cpu_enabled();
}

void SetAutocast(bool on_gpu, bool on) {
  if (on_gpu) {
    if (on) at::autocast::set_autocast_gpu_dtype(torch::kBFloat16);
    at::autocast::set_enabled(on);
  } else {
    if (on) at::autocast::set_autocast_cpu_dtype(torch::kBFloat16);
    at::autocast::set_cpu_enabled(on);
  }
}
#endif

}  // namespace

MixedPrecision::MixedPrecision(const torch::Device& device, bool wanted)
    : on_gpu_(device.is_cuda()), wanted_(wanted), before_(AutocastIsOn(on_gpu_)) {
  if (wanted_) SetAutocast(on_gpu_, true);
}

MixedPrecision::~MixedPrecision() {
  if (!wanted_) return;
  // The cache of half-precision weights must not outlive their next update.
  at::autocast::clear_cache();
  SetAutocast(on_gpu_, before_);
}

}  // namespace simwright::nn
