#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// Returns softmax(q k^T / sqrt(d)) v for q, k, v (B x heads x N x d): (B x N x heads d). Vaswani et
// al. 2017.
torch::Tensor Attention(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v);
// Attends only to the keys for which `key_mask` (B x N, bool) is true; at least one per row. An
// undefined mask admits all.
torch::Tensor Attention(const torch::Tensor& q, const torch::Tensor& k, const torch::Tensor& v,
                        const torch::Tensor& key_mask);

// Reshapes (B x N x heads d) -> (B x heads x N x d).
torch::Tensor SplitHeads(const torch::Tensor& x, std::int64_t heads);

// RMS normalisation along the last dimension with a learned scale (Zhang and Sennrich 2019).
class RmsNormImpl : public torch::nn::Module {
 public:
  explicit RmsNormImpl(std::int64_t size);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  torch::Tensor scale_;
};
TORCH_MODULE(RmsNorm);

// Returns the layer norm without learned weights, eps 1e-6, for scale and shift from outside.
torch::Tensor PlainLayerNorm(const torch::Tensor& x);

// Computes shifts, scales and gates of blocks from a conditioning vector: Linear(SiLU(vector)),
// initialised to zero so that a gated block starts as its skip connection (Peebles and Xie 2023,
// adaLN-Zero).
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

// Returns (1 + scale) norm(x) + shift.
torch::Tensor Modulated(const torch::Tensor& x, const torch::Tensor& shift,
                        const torch::Tensor& scale);

}  // namespace simwright::nn
