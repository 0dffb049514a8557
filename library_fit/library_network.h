#pragma once

#include <filesystem>
#include <vector>

#include "library_fit/prior_example.h"
#include "nn/blocks.h"
#include "nn/checkpoint.h"
#include "nn/torch.h"

namespace simwright::library_fit {

inline constexpr int kChoiceBins = 12;   // of [0, 1): divisible by 2, 3, 4 and 6
inline constexpr int kAzimuthBins = 36;  // of the full circle

// The parameters that the network predicts for a kind. B pictures.
struct LibraryNetworkOutput {
  torch::Tensor azimuth;  // (B x kAzimuthBins) logits
  torch::Tensor choices;  // (B x (kPriorDraws + 1) x kChoiceBins) logits
  // (B x 10) mean and logarithm of the deviation of the three logarithms of the size, the
  // elevation, and ten times the nearness.
  torch::Tensor numbers;
};

// The sizes of the network, which its weights' file keeps.
struct LibraryNetworkOptions {
  std::vector<int> channels = {48, 96, 192, 256};  // of the levels, each at half the resolution
  int features = 512;                              // of the picture

  nn::CheckpointMetadata Metadata() const;
  // Reads the sizes from the file `weights`. Throws core::Error for a file without valid ones.
  static LibraryNetworkOptions Of(const std::filesystem::path& weights);
};

// Predicts which kind of the library a crop shows, and the parameters of the instance given its
// kind: a residual network whose features meet an embedding of the kind in two dense layers.
class LibraryNetworkImpl : public torch::nn::Module {
 public:
  explicit LibraryNetworkImpl(int kinds, const LibraryNetworkOptions& options = {});

  // `pictures` (B x 4 x kPriorSide x kPriorSide): RGB in [-1, 1] times alpha, and alpha. Returns
  // (B x F) features.
  torch::Tensor Features(const torch::Tensor& pictures);
  // Returns the (B x kinds) logits.
  torch::Tensor KindLogits(const torch::Tensor& features);
  // Returns the parameters if pictures show `kinds` (B, int64).
  LibraryNetworkOutput Parameters(const torch::Tensor& features, const torch::Tensor& kinds);

 private:
  torch::nn::Conv2d stem_{nullptr};
  torch::nn::ModuleList blocks_{nullptr};
  torch::nn::GroupNorm norm_{nullptr};
  torch::nn::Linear feature_{nullptr}, kind_{nullptr}, hidden_{nullptr}, parameters_{nullptr};
  torch::nn::Embedding embedding_{nullptr};
};
TORCH_MODULE(LibraryNetwork);

// Returns the (count x 4 x side x side) network input for RGBA bytes (count x side x side x 4).
torch::Tensor LibraryPictures(const std::uint8_t* rgba, int count);

}  // namespace simwright::library_fit
