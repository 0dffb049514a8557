#include "scene/model/transformer_denoiser.h"

namespace simwright::scene {

using torch::nn::Linear;

AdaptiveBlockImpl::AdaptiveBlockImpl(std::int64_t width, std::int64_t heads, bool text)
    : heads_(heads) {
  modulation_ = register_module("modulation", nn::Modulation(width, 4));
  qkv_ = register_module("qkv", Linear(width, 3 * width));
  out_ = register_module("out", Linear(width, width));
  rise_ = register_module("rise", Linear(width, 4 * width));
  fall_ = register_module("fall", Linear(4 * width, width));
  if (text) cross_ = register_module("cross", CrossAttention(width, width, heads));
}

torch::Tensor AdaptiveBlockImpl::forward(torch::Tensor x, const torch::Tensor& vector,
                                         const EncodedText& text) {
  const std::vector<torch::Tensor> m = modulation_(vector);
  const std::vector<torch::Tensor> qkv = qkv_(nn::Modulated(x, m[0], m[1])).chunk(3, -1);
  x = x + out_(nn::Attention(nn::SplitHeads(qkv[0], heads_), nn::SplitHeads(qkv[1], heads_),
                             nn::SplitHeads(qkv[2], heads_)));
  if (text.IsDefined()) x = cross_(x, text);
  return x + fall_(torch::gelu(rise_(nn::Modulated(x, m[2], m[3]))));
}

TransformerDenoiser::TransformerDenoiser(const SceneModelOptions& options, int classes) {
  const std::int64_t width = options.width;
  const ClassShapes shapes = RegisterShapes(options, classes, EntryWidth(width), width);
  entry_ = register_module("entry", TokenInputHead(options, classes, shapes));
  time_ = register_module("time", TimeEmbedding(width));
  for (int i = 0; i < options.double_blocks + options.single_blocks; ++i) {
    blocks_->push_back(AdaptiveBlock(width, options.heads, options.text));
  }
  register_module("blocks", blocks_);
  RegisterText(options);
  exit_ = register_module("exit", TokenOutputHead(options, width, classes, shapes));
}

Denoised TransformerDenoiser::Predict(const NoisyScenes& scenes) {
  const torch::Tensor vector = time_(scenes.time);
  torch::Tensor x = entry_(scenes);
  for (const auto& block : *blocks_) {
    x = block->as<AdaptiveBlockImpl>()->forward(x, vector, scenes.text);
  }
  return exit_(x, scenes);
}

}  // namespace simwright::scene
