#include "scene/model/text_encoder.h"

#include "core/error.h"
#include "nn/transformer.h"

namespace simwright::scene {
namespace {

using torch::nn::LayerNorm;
using torch::nn::Linear;

constexpr std::int64_t kTextHeads = 4;
constexpr double kEmbeddingDeviation = 0.5;  // of the initial embeddings

torch::Tensor Rows(const torch::Tensor& all, std::int64_t first, std::int64_t count) {
  return all.defined() ? all.narrow(0, first, count) : all;
}

LayerNorm NormOf(std::int64_t width) {
  return LayerNorm(torch::nn::LayerNormOptions({width}));
}

}  // namespace

TextInput TextInput::Part(std::int64_t first, std::int64_t count) const {
  if (!IsDefined()) return {};
  const torch::Tensor rows = Rows(mask, first, count);
  const std::int64_t longest = rows.sum(1).max().item<std::int64_t>();
  const auto cut = [&](const torch::Tensor& all) {
    return all.defined() ? Rows(all, first, count).narrow(1, 0, longest) : all;
  };
  return {cut(pieces), cut(features), rows.narrow(1, 0, longest)};
}

TextInput TextInput::To(const torch::Device& device) const {
  const auto moved = [&](const torch::Tensor& one) { return one.defined() ? one.to(device) : one; };
  return {moved(pieces), moved(features), moved(mask)};
}

EncodedText EncodedText::Part(std::int64_t first, std::int64_t count) const {
  return {Rows(features, first, count), Rows(mask, first, count)};
}

TextLayerImpl::TextLayerImpl(std::int64_t width, std::int64_t heads) : heads_(heads) {
  first_norm_ = register_module("first_norm", NormOf(width));
  second_norm_ = register_module("second_norm", NormOf(width));
  qkv_ = register_module("qkv", Linear(width, 3 * width));
  out_ = register_module("out", Linear(width, width));
  rise_ = register_module("rise", Linear(width, 4 * width));
  fall_ = register_module("fall", Linear(4 * width, width));
}

torch::Tensor TextLayerImpl::forward(torch::Tensor x, const torch::Tensor& mask) {
  const std::vector<torch::Tensor> qkv = qkv_(first_norm_(x)).chunk(3, -1);
  x = x + out_(nn::Attention(nn::SplitHeads(qkv[0], heads_), nn::SplitHeads(qkv[1], heads_),
                             nn::SplitHeads(qkv[2], heads_), mask));
  return x + fall_(torch::gelu(rise_(second_norm_(x))));
}

TextEncoderImpl::TextEncoderImpl(const SceneModelOptions& options)
    : length_(options.text_length), features_(options.text_features) {
  const std::int64_t width = options.width;
  if (features_ > 0) {
    norm_ = register_module("norm", NormOf(features_));
    map_ = register_module("map", Linear(features_, width));
    return;
  }
  if (options.text_pieces < 1) throw core::Error("a text encoder needs a vocabulary of pieces");
  piece_ = register_module("piece", torch::nn::Embedding(options.text_pieces, width));
  position_ = register_parameter("position", kEmbeddingDeviation * torch::randn({length_, width}));
  {
    const torch::NoGradGuard no_gradient;
    piece_->weight.mul_(kEmbeddingDeviation);
  }
  for (int i = 0; i < options.text_layers; ++i) layers_->push_back(TextLayer(width, kTextHeads));
  register_module("layers", layers_);
  norm_ = register_module("norm", NormOf(width));
}

EncodedText TextEncoderImpl::forward(const TextInput& text) {
  if (features_ > 0) {
    if (!text.features.defined() || text.features.size(-1) != features_) {
      throw core::Error("the model reads text features of width " + std::to_string(features_), "",
                        "give the text encoder that it was trained with: --text-encoder FILE");
    }
    return {map_(norm_(text.features)), text.mask};
  }
  if (!text.pieces.defined()) throw core::Error("the model reads word pieces, not text features");
  const std::int64_t length = text.pieces.size(1);
  if (length > length_) {
    throw core::Error("a prompt has more pieces than the model reads", std::to_string(length),
                      std::to_string(length_) + " at most");
  }
  torch::Tensor x = piece_(text.pieces) + position_.narrow(0, 0, length);
  for (const auto& layer : *layers_) x = layer->as<TextLayerImpl>()->forward(x, text.mask);
  return {norm_(x), text.mask};
}

}  // namespace simwright::scene
