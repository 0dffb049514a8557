#include "nn/unet.h"

#include "core/error.h"

namespace simwright::nn {
namespace {

torch::nn::Conv2d Conv1(int in, int out) {
  return torch::nn::Conv2d(torch::nn::Conv2dOptions(in, out, 1));
}

torch::nn::Conv2d Conv3(int in, int out, int stride = 1) {
  return torch::nn::Conv2d(torch::nn::Conv2dOptions(in, out, 3).padding(1).stride(stride));
}

}  // namespace

bool UNetOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (in_channels < 1 || out_channels < 1) return fail("a U-Net needs input and output channels");
  if (patch < 1) return fail("a U-Net's patch must be at least one pixel");
  if (channels.empty() || blocks < 1) return fail("a U-Net needs at least one level and one block");
  if (heads < 1 || embedding < 0) return fail("heads must be positive and embedding not negative");
  for (const int count : channels) {
    if (count < 8 || count % 8 != 0 || count % heads != 0) {
      return fail("a U-Net's channels must be multiples of 8 and of its heads");
    }
  }
  return true;
}

UNetImpl::UNetImpl(const UNetOptions& options) : options_(options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error);
  const int fold = options.patch * options.patch;
  const std::vector<int>& channels = options.channels;
  const int levels = static_cast<int>(channels.size());
  entry_ = register_module("entry", Conv3(options.in_channels * fold, channels[0]));
  down_ = register_module("down", torch::nn::ModuleList());
  down_attention_ = register_module("down_attention", torch::nn::ModuleList());
  shrink_ = register_module("shrink", torch::nn::ModuleList());
  up_ = register_module("up", torch::nn::ModuleList());
  up_attention_ = register_module("up_attention", torch::nn::ModuleList());
  grow_ = register_module("grow", torch::nn::ModuleList());
  for (int level = 0; level < levels; ++level) {
    const int c = channels[static_cast<size_t>(level)];
    for (int b = 0; b < options.blocks; ++b) {
      down_->push_back(ResidualBlock(c, c, options.embedding));
      if (level >= options.attention_from) {
        down_attention_->push_back(SpatialAttention(c, options.heads));
      }
    }
    if (level + 1 < levels) {
      shrink_->push_back(Conv3(c, channels[static_cast<size_t>(level) + 1], 2));
    }
  }
  for (int level = levels - 1; level >= 0; --level) {
    const int c = channels[static_cast<size_t>(level)];
    for (int b = 0; b < options.blocks; ++b) {
      up_->push_back(ResidualBlock(b == 0 ? 2 * c : c, c, options.embedding));
      if (level >= options.attention_from) {
        up_attention_->push_back(SpatialAttention(c, options.heads));
      }
    }
    if (level > 0) grow_->push_back(Conv1(c, channels[static_cast<size_t>(level) - 1]));
  }
  exit_norm_ = register_module(
      "exit_norm", torch::nn::GroupNorm(torch::nn::GroupNormOptions(channels[0] / 8, channels[0])));
  exit_ = register_module("exit", Conv1(channels[0], options.out_channels * fold));
}

torch::Tensor UNetImpl::forward(const torch::Tensor& x, const torch::Tensor& embedding) {
  return ForwardWithBottleneck(x, embedding, nullptr);
}

torch::Tensor UNetImpl::ForwardWithBottleneck(const torch::Tensor& x,
                                              const torch::Tensor& embedding,
                                              torch::Tensor* bottleneck) {
  const int levels = static_cast<int>(options_.channels.size());
  torch::Tensor h = entry_(options_.patch > 1 ? torch::pixel_unshuffle(x, options_.patch) : x);
  std::vector<torch::Tensor> skips;
  size_t block = 0, attention = 0;
  for (int level = 0; level < levels; ++level) {
    for (int b = 0; b < options_.blocks; ++b) {
      h = down_->at<ResidualBlockImpl>(block++).forward(h, embedding);
      if (level >= options_.attention_from) {
        h = down_attention_->at<SpatialAttentionImpl>(attention++).forward(h);
      }
    }
    skips.push_back(h);
    if (level + 1 < levels) {
      h = shrink_->at<torch::nn::Conv2dImpl>(static_cast<size_t>(level)).forward(h);
    }
  }
  if (bottleneck != nullptr) *bottleneck = h.mean({2, 3});
  block = attention = 0;
  for (int level = levels - 1; level >= 0; --level) {
    h = torch::cat({h, skips[static_cast<size_t>(level)]}, 1);
    for (int b = 0; b < options_.blocks; ++b) {
      h = up_->at<ResidualBlockImpl>(block++).forward(h, embedding);
      if (level >= options_.attention_from) {
        h = up_attention_->at<SpatialAttentionImpl>(attention++).forward(h);
      }
    }
    if (level == 0) break;
    h = grow_->at<torch::nn::Conv2dImpl>(static_cast<size_t>(levels - 1 - level)).forward(h);
    h = torch::upsample_nearest2d(h, std::vector<std::int64_t>{h.size(2) * 2, h.size(3) * 2});
  }
  h = exit_(torch::silu(exit_norm_(h)));
  return options_.patch > 1 ? torch::pixel_shuffle(h, options_.patch) : h;
}

}  // namespace simwright::nn
