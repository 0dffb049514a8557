#pragma once

#include <string>
#include <vector>

#include "nn/blocks.h"
#include "nn/torch.h"

namespace simwright::nn {

struct UNetOptions {
  int in_channels = 4;
  int out_channels = 4;
  // The patch size folded into channels at the input and unfolded at the output: 2 quarters the
  // cost of the finest level, where a convolution learns least.
  int patch = 2;
  std::vector<int> channels = {48, 96, 192, 192};  // one per level, each at half the resolution of
                                                   // the one before
  int blocks = 1;                                  // residual blocks per level, in each direction
  int attention_from = 2;                          // first level with attention (8 x 8 for 64 / 2)
  int heads = 4;
  int embedding = 0;  // size of the conditioning vector; 0: none

  // Returns false, with the reason, for sizes that no network can have.
  bool IsValid(std::string* error) const;
};

// The U-Net of diffusion models (Ronneberger et al. 2015; Ho et al. 2020), at a smaller size.
class UNetImpl : public torch::nn::Module {
 public:
  // Throws core::Error for options that are not valid.
  explicit UNetImpl(const UNetOptions& options);

  // Returns (B x out_channels x H x W) for x (B x in_channels x H x W), H and W divisible by patch
  // * 2^(levels - 1), and embedding (B x embedding) or undefined.
  torch::Tensor forward(const torch::Tensor& x, const torch::Tensor& embedding = {});

  // Runs forward; `bottleneck` receives the mean of the coarsest features, (B x channels.back()).
  torch::Tensor ForwardWithBottleneck(const torch::Tensor& x, const torch::Tensor& embedding,
                                      torch::Tensor* bottleneck);

 private:
  UNetOptions options_;
  torch::nn::Conv2d entry_{nullptr}, exit_{nullptr};
  torch::nn::GroupNorm exit_norm_{nullptr};
  torch::nn::ModuleList down_, down_attention_, shrink_, up_, up_attention_, grow_;
};
TORCH_MODULE(UNet);

}  // namespace simwright::nn
