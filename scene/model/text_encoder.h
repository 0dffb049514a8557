#pragma once

#include "nn/torch.h"
#include "scene/model/model_options.h"

namespace simwright::scene {

// Prompts as a denoiser's input: either word pieces or features of an external encoder.
struct TextInput {
  torch::Tensor pieces;    // (B x L) int64, or undefined
  torch::Tensor features;  // (B x L x D), or undefined
  torch::Tensor mask;      // (B x L) bool: true where there is a piece, false in the padding

  bool IsDefined() const { return mask.defined(); }
  // Returns `count` prompts from `first` on, without the padding beyond the longest of them: views,
  // not copies.
  TextInput Part(std::int64_t first, std::int64_t count) const;
  TextInput To(const torch::Device& device) const;
};

// Prompts as the blocks of a denoiser attend to them.
struct EncodedText {
  torch::Tensor features;  // (B x L x width)
  torch::Tensor mask;      // (B x L) bool

  bool IsDefined() const { return mask.defined(); }
  EncodedText Part(std::int64_t first, std::int64_t count) const;
};

// A layer of the encoder: attention, then an MLP on each piece, each after a layer norm (Xiong et
// al. 2020).
class TextLayerImpl : public torch::nn::Module {
 public:
  TextLayerImpl(std::int64_t width, std::int64_t heads);
  torch::Tensor forward(torch::Tensor x, const torch::Tensor& mask);

 private:
  std::int64_t heads_;
  torch::nn::LayerNorm first_norm_{nullptr}, second_norm_{nullptr};
  torch::nn::Linear qkv_{nullptr}, out_{nullptr}, rise_{nullptr}, fall_{nullptr};
};
TORCH_MODULE(TextLayer);

// The text encoder of a denoiser. For word pieces: embeddings of pieces and positions, and
// options.text_layers layers, trained with the denoiser. For features of an external encoder, which
// stays as it is: a layer norm and a linear map to the denoiser's width.
class TextEncoderImpl : public torch::nn::Module {
 public:
  // Throws core::Error unless options.text_pieces or options.text_features is above 0.
  explicit TextEncoderImpl(const SceneModelOptions& options);
  // Throws core::Error for the other kind of input, or more pieces than options.text_length.
  EncodedText forward(const TextInput& text);

 private:
  std::int64_t length_, features_;
  torch::nn::Embedding piece_{nullptr};
  torch::Tensor position_;  // (length x width)
  torch::nn::ModuleList layers_;
  torch::nn::LayerNorm norm_{nullptr};
  torch::nn::Linear map_{nullptr};
};
TORCH_MODULE(TextEncoder);

}  // namespace simwright::scene
