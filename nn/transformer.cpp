#include "nn/transformer.h"

#include <cmath>
#include <limits>

#include <torch/version.h>

// libtorch 2.4 has an RMS norm of its own, which later versions compute in one kernel.
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
#define SIMWRIGHT_TORCH_HAS_RMS_NORM
#endif

namespace simwright::nn {
namespace {

constexpr double kNormEpsilon = 1e-6;

// Return softmax(q k^T / sqrt(d)) v, (B x heads x N x d).
#if TORCH_VERSION_MAJOR >= 2
torch::Tensor Attended(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v,
                       const torch::Tensor& key_mask) {
  if (!key_mask.defined()) return at::scaled_dot_product_attention(q, k, v);
  return at::scaled_dot_product_attention(q, k, v, key_mask.unsqueeze(1).unsqueeze(1));
}
#else
torch::Tensor Attended(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v,
                       const torch::Tensor& key_mask) {
  const double scale = 1.0 / std::sqrt(static_cast<double>(q.size(-1)));
  torch::Tensor scores = torch::matmul(q * scale, k.transpose(-2, -1));
  if (key_mask.defined()) {
    scores = scores.masked_fill(key_mask.logical_not().unsqueeze(1).unsqueeze(1),
                                -std::numeric_limits<float>::infinity());
  }
  return torch::matmul(torch::softmax(scores, -1), v);
}
#endif

}  // namespace

torch::Tensor Attention(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v) {
  return Attention(q, k, v, {});
}

torch::Tensor Attention(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v,
                        const torch::Tensor& key_mask) {
  const torch::Tensor mixed = Attended(q, k, v, key_mask).transpose(1, 2);
  return mixed.reshape({mixed.size(0), mixed.size(1), mixed.size(2) * mixed.size(3)});
}

torch::Tensor SplitHeads(const torch::Tensor& x, std::int64_t heads) {
  return x.reshape({x.size(0), x.size(1), heads, x.size(2) / heads}).transpose(1, 2);
}

RmsNormImpl::RmsNormImpl(std::int64_t size) {
  scale_ = register_parameter("scale", torch::ones({size}));
}

torch::Tensor RmsNormImpl::forward(const torch::Tensor& x) {
#ifdef SIMWRIGHT_TORCH_HAS_RMS_NORM
  // The kernel takes a scale of the input's type only, which nn::MixedPrecision halves.
  return at::rms_norm(x, {x.size(-1)}, scale_.to(x.scalar_type()), kNormEpsilon);
#else
  return x * torch::rsqrt(x.square().mean(-1, true) + kNormEpsilon) * scale_;
#endif
}

torch::Tensor PlainLayerNorm(const torch::Tensor& x) {
  return torch::layer_norm(x, {x.size(-1)}, {}, {}, kNormEpsilon);
}

ModulationImpl::ModulationImpl(std::int64_t width, std::int64_t count) : count_(count) {
  map_ = register_module("map", torch::nn::Linear(width, count * width));
  torch::nn::init::zeros_(map_->weight);
  torch::nn::init::zeros_(map_->bias);
}

std::vector<torch::Tensor> ModulationImpl::forward(const torch::Tensor& vector) {
  return map_(torch::silu(vector)).unsqueeze(1).chunk(count_, -1);
}

torch::Tensor Modulated(const torch::Tensor& x, const torch::Tensor& shift,
                        const torch::Tensor& scale) {
  return PlainLayerNorm(x) * (1.0 + scale) + shift;
}

}  // namespace simwright::nn
