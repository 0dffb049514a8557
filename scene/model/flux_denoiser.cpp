#include "scene/model/flux_denoiser.h"

namespace simwright::scene {
namespace {

using torch::nn::Linear;

constexpr std::int64_t kRatio = 4;  // ratio of the MLP's width to the block's

torch::Tensor Gelu(const torch::Tensor& x) {
  return torch::gelu(x, "tanh");
}

}  // namespace

DoubleBlockImpl::DoubleBlockImpl(std::int64_t width, std::int64_t heads) : heads_(heads) {
  modulation_ = register_module("modulation", nn::Modulation(width, 6));
  qkv_ = register_module("qkv", Linear(width, 3 * width));
  out_ = register_module("out", Linear(width, width));
  rise_ = register_module("rise", Linear(width, kRatio * width));
  fall_ = register_module("fall", Linear(kRatio * width, width));
  q_norm_ = register_module("q_norm", nn::RmsNorm(width / heads));
  k_norm_ = register_module("k_norm", nn::RmsNorm(width / heads));
}

torch::Tensor DoubleBlockImpl::forward(torch::Tensor x, const torch::Tensor& vector) {
  const std::vector<torch::Tensor> m = modulation_(vector);
  const std::vector<torch::Tensor> qkv = qkv_(nn::Modulated(x, m[0], m[1])).chunk(3, -1);
  x = x + m[2] * out_(nn::Attention(q_norm_(nn::SplitHeads(qkv[0], heads_)),
                                    k_norm_(nn::SplitHeads(qkv[1], heads_)),
                                    nn::SplitHeads(qkv[2], heads_)));
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

torch::Tensor SingleBlockImpl::forward(const torch::Tensor& x, const torch::Tensor& vector) {
  const std::vector<torch::Tensor> m = modulation_(vector);
  const std::vector<torch::Tensor> parts =
      in_(nn::Modulated(x, m[0], m[1]))
          .split_with_sizes({width_, width_, width_, kRatio * width_}, -1);
  const torch::Tensor attention =
      nn::Attention(q_norm_(nn::SplitHeads(parts[0], heads_)),
                    k_norm_(nn::SplitHeads(parts[1], heads_)), nn::SplitHeads(parts[2], heads_));
  return x + m[2] * out_(torch::cat({attention, Gelu(parts[3])}, -1));
}

FluxDenoiser::FluxDenoiser(const SceneModelOptions& options, int classes) {
  const std::int64_t width = options.width;
  const ClassShapes shapes = RegisterShapes(options, classes, EntryWidth(width), width / 2);
  entry_ = register_module("entry", TokenInputHead(options, classes, shapes));
  time_ = register_module("time", TimeEmbedding(width));
  for (int i = 0; i < options.double_blocks; ++i) {
    double_blocks_->push_back(DoubleBlock(width, options.heads));
  }
  for (int i = 0; i < options.single_blocks; ++i) {
    single_blocks_->push_back(SingleBlock(width, options.heads));
  }
  register_module("double_blocks", double_blocks_);
  register_module("single_blocks", single_blocks_);
  last_ = register_module("last", nn::Modulation(width, 2));
  narrow_ = register_module("narrow", Linear(width, width / 2));
  exit_ = register_module("exit", TokenOutputHead(options, width / 2, classes, shapes));
}

Denoised FluxDenoiser::Predict(const NoisyScenes& scenes) {
  const torch::Tensor vector = time_(scenes.time);
  torch::Tensor x = entry_(scenes);
  for (const auto& block : *double_blocks_) {
    x = block->as<DoubleBlockImpl>()->forward(x, vector);
  }
  for (const auto& block : *single_blocks_) {
    x = block->as<SingleBlockImpl>()->forward(x, vector);
  }
  const std::vector<torch::Tensor> m = last_(vector);
  return exit_(narrow_(nn::Modulated(x, m[0], m[1])), scenes);
}

}  // namespace simwright::scene
