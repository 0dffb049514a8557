#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// softmax(q k^T / sqrt(d)) v for q, k, v (B x heads x N x d): (B x N x heads d). Vaswani et al.
// 2017.
torch::Tensor Attention(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v);

// (B x N x heads d) -> (B x heads x N x d).
torch::Tensor SplitHeads(const torch::Tensor& x, std::int64_t heads);

// x over the root of the mean of its squares, along the last dimension, times a learned scale
// (Zhang and Sennrich 2019).
class RmsNormImpl : public torch::nn::Module {
 public:
  explicit RmsNormImpl(std::int64_t size);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::Tensor scale_;
};
TORCH_MODULE(RmsNorm);

// Layer norm without weights of its own, eps 1e-6: what is scaled and shifted from outside.
torch::Tensor PlainLayerNorm(const torch::Tensor& x);

// Shifts, scales and gates of blocks from a conditioning vector: Linear(SiLU(vector)), zero at the
// start, so that a gated block begins as its skip (Peebles and Xie 2023, adaLN-Zero).
class ModulationImpl : public torch::nn::Module {
 public:
  // `count` vectors of `width` each.
  ModulationImpl(std::int64_t width, std::int64_t count);
  // (B x width) -> `count` of (B x 1 x width).
  std::vector<torch::Tensor> forward(const torch::Tensor& vector);

 private:
  std::int64_t count_;
  torch::nn::Linear map_{nullptr};
};
TORCH_MODULE(Modulation);

// (1 + scale) norm(x) + shift.
torch::Tensor Modulated(const torch::Tensor& x, const torch::Tensor& shift,
                        const torch::Tensor& scale);

}  // namespace simwright::nn
