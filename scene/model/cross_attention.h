#pragma once

#include "nn/torch.h"
#include "scene/model/text_encoder.h"

namespace simwright::scene {

// Attention of a scene's tokens to a prompt, after a layer norm, with a residual connection
// (Vaswani et al. 2017): how the baselines read prompts.
class CrossAttentionImpl : public torch::nn::Module {
 public:
  // `width`: of the tokens; `text_width`: of the encoded text.
  CrossAttentionImpl(std::int64_t width, std::int64_t text_width, std::int64_t heads);
  // x (B x N x width) -> (B x N x width).
  torch::Tensor forward(const torch::Tensor& x, const EncodedText& text);

 private:
  std::int64_t heads_;
  torch::nn::Linear query_{nullptr}, key_value_{nullptr}, out_{nullptr};
};
TORCH_MODULE(CrossAttention);

}  // namespace simwright::scene
