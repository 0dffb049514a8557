#pragma once

#include "nn/transformer.h"
#include "scene/model/token_heads.h"

namespace simwright::scene {

// A stream of a double-stream block: the weights that act on the tokens of one kind, those of the
// scene or those of the prompt. Gated attention, then a gated MLP on each token.
class StreamImpl : public torch::nn::Module {
 public:
  StreamImpl(std::int64_t width, std::int64_t heads);

  // The input of the attention (B x heads x N x width / heads), and the gates of the block.
  struct Query {
    torch::Tensor q, k, v;
    std::vector<torch::Tensor> modulation;  // 6 of (B x 1 x width)
  };
  // x (B x N x width), vector (B x width).
  Query Ask(const torch::Tensor& x, const torch::Tensor& vector);
  // Returns the tokens after attention, whose result for them is `attended` (B x N x width), and
  // MLP.
  torch::Tensor Answer(torch::Tensor x, const Query& query, const torch::Tensor& attended);

 private:
  std::int64_t heads_;
  nn::Modulation modulation_{nullptr};
  torch::nn::Linear qkv_{nullptr}, out_{nullptr}, rise_{nullptr}, fall_{nullptr};
  nn::RmsNorm q_norm_{nullptr}, k_norm_{nullptr};
};
TORCH_MODULE(Stream);

// Attention and MLP in parallel: one linear map before both, one after.
class SingleBlockImpl : public torch::nn::Module {
 public:
  SingleBlockImpl(std::int64_t width, std::int64_t heads);
  // key_mask (B x N, bool): the tokens to attend to; undefined: all.
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& vector,
                        const torch::Tensor& key_mask);

 private:
  std::int64_t width_, heads_;
  nn::Modulation modulation_{nullptr};
  torch::nn::Linear in_{nullptr}, out_{nullptr};
  nn::RmsNorm q_norm_{nullptr}, k_norm_{nullptr};
};
TORCH_MODULE(SingleBlock);

// A transformer without positional encoding of the scene: its output is equivariant to permutations
// of the tokens. Sizes and order of the blocks as in Pfaff et al., Steerable Scene Generation,
// appendix. A prompt has a stream of its own in the double-stream blocks, which attends jointly
// with the scene's; the single-stream blocks act on the tokens of both, as in Flux.
class FluxDenoiser : public Denoiser {
 public:
  FluxDenoiser(const SceneModelOptions& options, int classes);
  Denoised Predict(const NoisyScenes& scenes) override;

 private:
  torch::Tensor PredictWithText(const torch::Tensor& scene, const EncodedText& text,
                                const torch::Tensor& vector);

  TokenInputHead entry_{nullptr};
  TimeEmbedding time_{nullptr};
  torch::nn::ModuleList double_blocks_, text_blocks_, single_blocks_;
  nn::Modulation last_{nullptr};
  torch::nn::Linear narrow_{nullptr};
  TokenOutputHead exit_{nullptr};
};

}  // namespace simwright::scene
