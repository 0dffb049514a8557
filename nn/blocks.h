#pragma once

#include "nn/torch.h"

namespace simwright::nn {

// Returns sines and cosines of `values` (B) at `size` / 2 frequencies from 1 down to 1 /
// max_period: (B x size). Vaswani et al. 2017.
torch::Tensor SinusoidalEmbedding(const torch::Tensor& values, int size,
                                  double max_period = 10000.0);

// Two 3 x 3 convolutions with group norms and a skip connection; an embedding (B x embedding_size)
// scales and shifts between them (FiLM, Perez et al. 2018). embedding_size 0: none.
class ResidualBlockImpl : public torch::nn::Module {
 public:
  ResidualBlockImpl(int in, int out, int embedding_size);
  // x (B x in x H x W) -> (B x out x H x W).
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& embedding);

 private:
  torch::nn::GroupNorm norm1_{nullptr}, norm2_{nullptr};
  torch::nn::Conv2d conv1_{nullptr}, conv2_{nullptr}, skip_{nullptr};
  torch::nn::Linear film_{nullptr};
};
TORCH_MODULE(ResidualBlock);

// Self-attention over the positions of a feature map, with a skip connection (Vaswani et al. 2017).
class SpatialAttentionImpl : public torch::nn::Module {
 public:
  SpatialAttentionImpl(int channels, int heads);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  int heads_;
  torch::nn::GroupNorm norm_{nullptr};
  torch::nn::Conv2d qkv_{nullptr}, out_{nullptr};
};
TORCH_MODULE(SpatialAttention);

}  // namespace simwright::nn
