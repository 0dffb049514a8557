#pragma once

#include "nn/transformer.h"
#include "scene/model/cross_attention.h"
#include "scene/model/token_heads.h"

namespace simwright::scene {

// Attention, then an MLP on each token; time scales and shifts the norm before each. With `text`,
// cross-attention to the prompt between them.
class AdaptiveBlockImpl : public torch::nn::Module {
 public:
  AdaptiveBlockImpl(std::int64_t width, std::int64_t heads, bool text);
  torch::Tensor forward(torch::Tensor x, const torch::Tensor& vector, const EncodedText& text);

 private:
  std::int64_t heads_;
  nn::Modulation modulation_{nullptr};
  torch::nn::Linear qkv_{nullptr}, out_{nullptr}, rise_{nullptr}, fall_{nullptr};
  CrossAttention cross_{nullptr};
};
TORCH_MODULE(AdaptiveBlock);

// The denoiser of MiDiffusion (Hu et al. 2024): a transformer with 4 heads, MLPs of four times the
// width, layer norms conditioned on time, no gates.
class TransformerDenoiser : public Denoiser {
 public:
  TransformerDenoiser(const SceneModelOptions& options, int classes);
  Denoised Predict(const NoisyScenes& scenes) override;

 private:
  TokenInputHead entry_{nullptr};
  TimeEmbedding time_{nullptr};
  torch::nn::ModuleList blocks_;
  TokenOutputHead exit_{nullptr};
};

}  // namespace simwright::scene
