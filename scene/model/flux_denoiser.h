#pragma once

#include "nn/transformer.h"
#include "scene/model/token_heads.h"

namespace simwright::scene {

// Gated attention between tokens, then a gated MLP on each token (the scene stream of Flux's
// double-stream blocks; a text stream would share the attention).
class DoubleBlockImpl : public torch::nn::Module {
 public:
  DoubleBlockImpl(std::int64_t width, std::int64_t heads);
  // x (B x N x width), vector (B x width).
  torch::Tensor forward(torch::Tensor x, const torch::Tensor& vector);

 private:
  std::int64_t heads_;
  nn::Modulation modulation_{nullptr};
  torch::nn::Linear qkv_{nullptr}, out_{nullptr}, rise_{nullptr}, fall_{nullptr};
  nn::RmsNorm q_norm_{nullptr}, k_norm_{nullptr};
};
TORCH_MODULE(DoubleBlock);

// Attention and MLP in parallel: one linear map before both, one after.
class SingleBlockImpl : public torch::nn::Module {
 public:
  SingleBlockImpl(std::int64_t width, std::int64_t heads);
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& vector);

 private:
  std::int64_t width_, heads_;
  nn::Modulation modulation_{nullptr};
  torch::nn::Linear in_{nullptr}, out_{nullptr};
  nn::RmsNorm q_norm_{nullptr}, k_norm_{nullptr};
};
TORCH_MODULE(SingleBlock);

// A transformer without positional encoding: its output is equivariant to permutations of the
// tokens. Sizes and order of the blocks as in Pfaff et al., Steerable Scene Generation, appendix.
class FluxDenoiser : public Denoiser {
 public:
  FluxDenoiser(const SceneModelOptions& options, int classes);
  Denoised Predict(const NoisyScenes& scenes) override;

 private:
  TokenInputHead entry_{nullptr};
  TimeEmbedding time_{nullptr};
  torch::nn::ModuleList double_blocks_, single_blocks_;
  nn::Modulation last_{nullptr};
  torch::nn::Linear narrow_{nullptr};
  TokenOutputHead exit_{nullptr};
};

}  // namespace simwright::scene
