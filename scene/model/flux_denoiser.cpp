#include "scene/model/flux_denoiser.h"

namespace simwright::scene {
namespace {

using torch::nn::Linear;

constexpr std::int64_t kRatio = 4;  // ratio of the MLP's width to the block's

torch::Tensor Gelu(const torch::Tensor& x) {
  return torch::gelu(x, "tanh");
}

}  // namespace

StreamImpl::StreamImpl(std::int64_t width, std::int64_t heads) : heads_(heads) {
  modulation_ = register_module("modulation", nn::Modulation(width, 6));
  qkv_ = register_module("qkv", Linear(width, 3 * width));
  out_ = register_module("out", Linear(width, width));
  rise_ = register_module("rise", Linear(width, kRatio * width));
  fall_ = register_module("fall", Linear(kRatio * width, width));
  q_norm_ = register_module("q_norm", nn::RmsNorm(width / heads));
  k_norm_ = register_module("k_norm", nn::RmsNorm(width / heads));
}

StreamImpl::Query StreamImpl::Ask(const torch::Tensor& x, const torch::Tensor& vector) {
  Query query;
  query.modulation = modulation_(vector);
  const std::vector<torch::Tensor> qkv =
      qkv_(nn::Modulated(x, query.modulation[0], query.modulation[1])).chunk(3, -1);
  query.q = q_norm_(nn::SplitHeads(qkv[0], heads_));
  query.k = k_norm_(nn::SplitHeads(qkv[1], heads_));
  query.v = nn::SplitHeads(qkv[2], heads_);
  return query;
}

torch::Tensor StreamImpl::Answer(torch::Tensor x, const Query& query,
                                 const torch::Tensor& attended) {
  const std::vector<torch::Tensor>& m = query.modulation;
  x = x + m[2] * out_(attended);
  return x + m[5] * fall_(Gelu(rise_(nn::Modulated(x, m[3], m[4]))));
}

SingleBlockImpl::SingleBlockImpl(std::int64_t width, std::int64_t heads)
    : width_(width), heads_(heads) {
  modulation_ = register_module("modulation", nn::Modulation(width, 3));
  in_ = register_module("in", Linear(width, (3 + kRatio) * width));
  out_ = register_module("out", Linear((1 + kRatio) * width, width));
  q_norm_ = register_module("q_norm", nn::RmsNorm(width / heads));
  k_norm_ = register_module("k_norm", nn::RmsNorm(width / heads));
}

torch::Tensor SingleBlockImpl::forward(const torch::Tensor& x, const torch::Tensor& vector,
                                       const torch::Tensor& key_mask) {
  const std::vector<torch::Tensor> m = modulation_(vector);
  const std::vector<torch::Tensor> parts =
      in_(nn::Modulated(x, m[0], m[1]))
          .split_with_sizes({width_, width_, width_, kRatio * width_}, -1);
  const torch::Tensor attention = nn::Attention(q_norm_(nn::SplitHeads(parts[0], heads_)),
                                                k_norm_(nn::SplitHeads(parts[1], heads_)),
                                                nn::SplitHeads(parts[2], heads_), key_mask);
  return x + m[2] * out_(torch::cat({attention, Gelu(parts[3])}, -1));
}

FluxDenoiser::FluxDenoiser(const SceneModelOptions& options, int classes) {
  const std::int64_t width = options.width;
  const ClassShapes shapes = RegisterShapes(options, classes, EntryWidth(width), width / 2);
  entry_ = register_module("entry", TokenInputHead(options, classes, shapes));
  time_ = register_module("time", TimeEmbedding(width));
  for (int i = 0; i < options.double_blocks; ++i) {
    double_blocks_->push_back(Stream(width, options.heads));
    if (options.text) text_blocks_->push_back(Stream(width, options.heads));
  }
  for (int i = 0; i < options.single_blocks; ++i) {
    single_blocks_->push_back(SingleBlock(width, options.heads));
  }
  register_module("double_blocks", double_blocks_);
  if (options.text) register_module("text_blocks", text_blocks_);
  RegisterText(options);
  register_module("single_blocks", single_blocks_);
  last_ = register_module("last", nn::Modulation(width, 2));
  narrow_ = register_module("narrow", Linear(width, width / 2));
  exit_ = register_module("exit", TokenOutputHead(options, width / 2, classes, shapes));
}

torch::Tensor FluxDenoiser::PredictWithText(const torch::Tensor& scene, const EncodedText& text,
                                            const torch::Tensor& vector) {
  const std::int64_t pieces = text.features.size(1), tokens = scene.size(1);
  torch::Tensor x = scene, words = text.features;
  const torch::Tensor mask =
      torch::cat({text.mask, text.mask.new_ones({scene.size(0), tokens})}, 1);
  const auto join = [](const torch::Tensor& a, const torch::Tensor& b) {
    return torch::cat({a, b}, 2);
  };
  for (size_t i = 0; i < double_blocks_->size(); ++i) {
    StreamImpl* const on_scene = double_blocks_[i]->as<StreamImpl>();
    StreamImpl* const on_text = text_blocks_[i]->as<StreamImpl>();
    const StreamImpl::Query a = on_text->Ask(words, vector), b = on_scene->Ask(x, vector);
    const torch::Tensor attended =
        nn::Attention(join(a.q, b.q), join(a.k, b.k), join(a.v, b.v), mask);
    words = on_text->Answer(words, a, attended.narrow(1, 0, pieces));
    x = on_scene->Answer(x, b, attended.narrow(1, pieces, tokens));
  }
  x = torch::cat({words, x}, 1);
  for (const auto& block : *single_blocks_) {
    x = block->as<SingleBlockImpl>()->forward(x, vector, mask);
  }
  return x.narrow(1, pieces, tokens);
}

Denoised FluxDenoiser::Predict(const NoisyScenes& scenes) {
  const torch::Tensor vector = time_(scenes.time);
  torch::Tensor x = entry_(scenes);
  if (scenes.text.IsDefined()) {
    x = PredictWithText(x, scenes.text, vector);
  } else {
    for (const auto& block : *double_blocks_) {
      StreamImpl* const stream = block->as<StreamImpl>();
      const StreamImpl::Query query = stream->Ask(x, vector);
      x = stream->Answer(x, query, nn::Attention(query.q, query.k, query.v));
    }
    for (const auto& block : *single_blocks_) {
      x = block->as<SingleBlockImpl>()->forward(x, vector, {});
    }
  }
  const std::vector<torch::Tensor> m = last_(vector);
  return exit_(narrow_(nn::Modulated(x, m[0], m[1])), scenes);
}

}  // namespace simwright::scene
