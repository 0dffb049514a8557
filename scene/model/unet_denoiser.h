#pragma once

#include "scene/model/cross_attention.h"
#include "scene/model/token_heads.h"

namespace simwright::scene {

// A residual block of two pointwise convolutions with group norms; time scales and shifts between
// them.
class TokenResidualImpl : public torch::nn::Module {
 public:
  TokenResidualImpl(std::int64_t in, std::int64_t out, std::int64_t time_width);
  // x (B x in x N), vector (B x time_width) -> (B x out x N).
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& vector);

 private:
  torch::nn::Linear film_{nullptr};
  torch::nn::Conv1d first_{nullptr}, second_{nullptr}, skip_{nullptr};
  torch::nn::GroupNorm first_norm_{nullptr}, second_norm_{nullptr};
};
TORCH_MODULE(TokenResidual);

// Attention between tokens with a residual connection. `linear`: softmax over features and over
// tokens separately, so that the cost is linear in the tokens (Shen et al. 2021).
class TokenAttentionImpl : public torch::nn::Module {
 public:
  TokenAttentionImpl(std::int64_t width, std::int64_t heads, bool linear);
  torch::Tensor forward(const torch::Tensor& x);

 private:
  std::int64_t heads_;
  bool linear_;
  torch::nn::GroupNorm norm_{nullptr};
  torch::nn::Conv1d qkv_{nullptr}, out_{nullptr};
};
TORCH_MODULE(TokenAttention);

// The denoiser of DiffuScene (Tang et al. 2024): a U-Net along the scene's objects, four levels of
// one width (multipliers 1/1/1/1); each attention is followed by one to the prompt. Its
// convolutions are pointwise and all its levels have the length of the scene: objects have no
// neighbours and interact in the attention only.
class UnetDenoiser : public Denoiser {
 public:
  UnetDenoiser(const SceneModelOptions& options, int classes);
  Denoised Predict(const NoisyScenes& scenes) override;

 private:
  TokenInputHead entry_{nullptr};
  TimeEmbedding time_{nullptr};
  torch::nn::ModuleList down_, middle_, up_, cross_;
  TokenOutputHead exit_{nullptr};
};

}  // namespace simwright::scene
