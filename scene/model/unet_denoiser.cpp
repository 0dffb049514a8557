#include "scene/model/unet_denoiser.h"

#include <numeric>

#include "nn/transformer.h"

namespace simwright::scene {
namespace {

constexpr int kLevels = 4;

torch::nn::Conv1d Pointwise(std::int64_t in, std::int64_t out) {
  return torch::nn::Conv1d(torch::nn::Conv1dOptions(in, out, 1));
}

torch::nn::GroupNorm Norm(std::int64_t width) {
  return torch::nn::GroupNorm(torch::nn::GroupNormOptions(std::gcd<std::int64_t>(width, 8), width));
}

}  // namespace

TokenResidualImpl::TokenResidualImpl(std::int64_t in, std::int64_t out, std::int64_t time_width) {
  film_ = register_module("film", torch::nn::Linear(time_width, 2 * out));
  first_ = register_module("first", Pointwise(in, out));
  second_ = register_module("second", Pointwise(out, out));
  first_norm_ = register_module("first_norm", Norm(out));
  second_norm_ = register_module("second_norm", Norm(out));
  if (in != out) skip_ = register_module("skip", Pointwise(in, out));
}

torch::Tensor TokenResidualImpl::forward(const torch::Tensor& x, const torch::Tensor& vector) {
  const std::vector<torch::Tensor> film = film_(torch::silu(vector)).unsqueeze(-1).chunk(2, 1);
  torch::Tensor h = first_norm_(first_(x)) * (1.0 + film[0]) + film[1];
  h = torch::silu(second_norm_(second_(torch::silu(h))));
  return h + (skip_ ? skip_(x) : x);
}

TokenAttentionImpl::TokenAttentionImpl(std::int64_t width, std::int64_t heads, bool linear)
    : heads_(heads), linear_(linear) {
  norm_ = register_module("norm", torch::nn::GroupNorm(torch::nn::GroupNormOptions(1, width)));
  qkv_ = register_module("qkv", Pointwise(width, 3 * width));
  out_ = register_module("out", Pointwise(width, width));
}

torch::Tensor TokenAttentionImpl::forward(const torch::Tensor& x) {
  const std::vector<torch::Tensor> qkv = qkv_(norm_(x)).chunk(3, 1);
  const auto split = [&](const torch::Tensor& one) {
    return nn::SplitHeads(one.transpose(1, 2), heads_);  // (B x heads x N x d)
  };
  const torch::Tensor q = split(qkv[0]), k = split(qkv[1]), v = split(qkv[2]);
  if (!linear_) return x + out_(nn::Attention(q, k, v).transpose(1, 2));
  const torch::Tensor context =
      torch::matmul(torch::softmax(k, -2).transpose(-2, -1), v);  // (B x heads x d x d)
  const torch::Tensor mixed = torch::matmul(torch::softmax(q, -1), context);
  return x + out_(mixed.transpose(-2, -1).reshape(x.sizes()));
}

UnetDenoiser::UnetDenoiser(const SceneModelOptions& options, int classes) {
  const std::int64_t width = options.width, heads = options.heads;
  entry_ = register_module("entry", TokenInputHead(options, classes));
  time_ = register_module("time", TimeEmbedding(width));
  for (int level = 0; level < kLevels; ++level) {
    down_->push_back(TokenResidual(width, width, width));
    down_->push_back(TokenResidual(width, width, width));
    down_->push_back(TokenAttention(width, heads, true));
    // The features of the downward path are concatenated with those from below.
    up_->push_back(TokenResidual(2 * width, width, width));
    up_->push_back(TokenResidual(2 * width, width, width));
    up_->push_back(TokenAttention(width, heads, true));
  }
  middle_->push_back(TokenResidual(width, width, width));
  middle_->push_back(TokenAttention(width, heads, false));
  middle_->push_back(TokenResidual(width, width, width));
  register_module("down", down_);
  register_module("middle", middle_);
  register_module("up", up_);
  if (options.text) {
    for (int i = 0; i < 2 * kLevels + 1; ++i)
      cross_->push_back(CrossAttention(width, width, heads));
    register_module("cross", cross_);
  }
  RegisterText(options);
  exit_ = register_module("exit", TokenOutputHead(options, width, classes));
}

Denoised UnetDenoiser::Predict(const NoisyScenes& scenes) {
  const torch::Tensor vector = time_(scenes.time);
  torch::Tensor x = entry_(scenes).transpose(1, 2);  // (B x width x N)
  const auto residual = [&](torch::nn::ModuleList& list, size_t i, const torch::Tensor& in) {
    return list[i]->as<TokenResidualImpl>()->forward(in, vector);
  };
  size_t attended = 0;
  const auto attend = [&](torch::nn::ModuleList& list, size_t i) {
    x = list[i]->as<TokenAttentionImpl>()->forward(x);
    if (!scenes.text.IsDefined()) return;
    CrossAttentionImpl* const cross = cross_[attended++]->as<CrossAttentionImpl>();
    x = cross->forward(x.transpose(1, 2), scenes.text).transpose(1, 2);
  };
  std::vector<torch::Tensor> passed;
  for (size_t level = 0; level < kLevels; ++level) {
    x = residual(down_, 3 * level, x);
    passed.push_back(x);
    x = residual(down_, 3 * level + 1, x);
    attend(down_, 3 * level + 2);
    passed.push_back(x);
  }
  x = residual(middle_, 0, x);
  attend(middle_, 1);
  x = residual(middle_, 2, x);
  for (size_t level = 0; level < kLevels; ++level) {
    for (size_t i = 0; i < 2; ++i) {
      x = residual(up_, 3 * level + i, torch::cat({x, passed.back()}, 1));
      passed.pop_back();
    }
    attend(up_, 3 * level + 2);
  }
  return exit_(x.transpose(1, 2), scenes);
}

}  // namespace simwright::scene
