#include "nn/blocks.h"

#include <cmath>
#include <numeric>

#include <torch/version.h>

namespace simwright::nn {
namespace {

// Returns a group norm with groups of about 8 channels that divide the channels evenly.
torch::nn::GroupNorm Norm(int channels) {
  return torch::nn::GroupNorm(
      torch::nn::GroupNormOptions(std::gcd(channels, std::max(1, channels / 8)), channels));
}

torch::nn::Conv2d Conv(int in, int out, int size) {
  return torch::nn::Conv2d(torch::nn::Conv2dOptions(in, out, size).padding(size / 2));
}

}  // namespace

torch::Tensor SinusoidalEmbedding(const torch::Tensor& values, int size, double max_period) {
  const int half = size / 2;
  const torch::Tensor frequencies =
      torch::exp(torch::arange(half, values.options().dtype(torch::kFloat)) *
                 (-std::log(max_period) / std::max(1, half - 1)));
  const torch::Tensor angles = values.to(torch::kFloat).unsqueeze(1) * frequencies.unsqueeze(0);
  return torch::cat({torch::sin(angles), torch::cos(angles)}, 1);
}

ResidualBlockImpl::ResidualBlockImpl(int in, int out, int embedding_size) {
  norm1_ = register_module("norm1", Norm(in));
  conv1_ = register_module("conv1", Conv(in, out, 3));
  norm2_ = register_module("norm2", Norm(out));
  conv2_ = register_module("conv2", Conv(out, out, 3));
  torch::nn::init::zeros_(conv2_->weight);  // a block starts as its skip connection
  torch::nn::init::zeros_(conv2_->bias);
  if (in != out) skip_ = register_module("skip", Conv(in, out, 1));
  if (embedding_size > 0) {
    film_ = register_module("film", torch::nn::Linear(embedding_size, 2 * out));
  }
}

torch::Tensor ResidualBlockImpl::forward(const torch::Tensor& x, const torch::Tensor& embedding) {
  torch::Tensor h = norm2_(conv1_(torch::silu(norm1_(x))));
  if (film_) {
    const std::vector<torch::Tensor> film =
        film_(torch::silu(embedding)).unsqueeze(-1).unsqueeze(-1).chunk(2, 1);
    h = h * (1.0 + film[0]) + film[1];
  }
  h = conv2_(torch::silu(h));
  return (skip_ ? skip_(x) : x) + h;
}

SpatialAttentionImpl::SpatialAttentionImpl(int channels, int heads) : heads_(heads) {
  norm_ = register_module("norm", Norm(channels));
  qkv_ = register_module("qkv", Conv(channels, 3 * channels, 1));
  out_ = register_module("out", Conv(channels, channels, 1));
  torch::nn::init::zeros_(out_->weight);
  torch::nn::init::zeros_(out_->bias);
}

torch::Tensor SpatialAttentionImpl::forward(const torch::Tensor& x) {
  const auto batch = x.size(0), channels = x.size(1), positions = x.size(2) * x.size(3);
  const auto size = channels / heads_;
  // (3, B, heads, positions, size)
  const torch::Tensor qkv =
      qkv_(norm_(x)).reshape({batch, 3, heads_, size, positions}).permute({1, 0, 2, 4, 3});
#if TORCH_VERSION_MAJOR >= 2
  const torch::Tensor attended = at::scaled_dot_product_attention(qkv[0], qkv[1], qkv[2]);
#else
  const torch::Tensor weights = torch::softmax(
      torch::matmul(qkv[0], qkv[1].transpose(-2, -1)) / std::sqrt(static_cast<double>(size)), -1);
  const torch::Tensor attended = torch::matmul(weights, qkv[2]);
#endif
  return x + out_(attended.permute({0, 1, 3, 2}).reshape(x.sizes()));
}

}  // namespace simwright::nn
