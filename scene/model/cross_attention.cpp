#include "scene/model/cross_attention.h"

#include "nn/transformer.h"

namespace simwright::scene {

using torch::nn::Linear;

CrossAttentionImpl::CrossAttentionImpl(std::int64_t width, std::int64_t text_width,
                                       std::int64_t heads)
    : heads_(heads) {
  query_ = register_module("query", Linear(width, width));
  key_value_ = register_module("key_value", Linear(text_width, 2 * width));
  out_ = register_module("out", Linear(width, width));
}

torch::Tensor CrossAttentionImpl::forward(const torch::Tensor& x, const EncodedText& text) {
  const std::vector<torch::Tensor> key_value = key_value_(text.features).chunk(2, -1);
  return x + out_(nn::Attention(nn::SplitHeads(query_(nn::PlainLayerNorm(x)), heads_),
                                nn::SplitHeads(key_value[0], heads_),
                                nn::SplitHeads(key_value[1], heads_), text.mask));
}

}  // namespace simwright::scene
