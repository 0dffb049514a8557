#pragma once

#include <cstdint>
#include <filesystem>

#include "nn/blocks.h"
#include "nn/checkpoint.h"
#include "nn/torch.h"
#include "nn/unet.h"
#include "twin/detector_network_options.h"

namespace simwright::twin {

// The offsets that the network predicts are in units of this many pixels.
inline constexpr double kOffsetUnit = 16.0;

// The network's answer for B pictures of H x W pixels.
struct DetectorOutput {
  torch::Tensor object;  // (B x 1 x H x W) logits: the pixel shows an object
  torch::Tensor centre;  // (B x 1 x H x W) logits of the heat around the objects' centres
  torch::Tensor offset;  // (B x 2 x H x W) from the pixel to its object's centre, kOffsetUnit
};

// Returns the entries of a weights' file that state the sizes.
nn::CheckpointMetadata MetadataOf(const DetectorNetworkOptions& options);
// Reads the sizes from the file `weights`. Throws core::Error for a file without valid ones.
DetectorNetworkOptions ReadDetectorSizes(const std::filesystem::path& weights);

// Finds the objects on a table as a U-Net that tells for each pixel whether it shows an object, and
// where the middle of that object is (Cheng et al. 2020, "Panoptic-DeepLab").
class DetectorNetworkImpl : public torch::nn::Module {
 public:
  explicit DetectorNetworkImpl(const DetectorNetworkOptions& options = {});

  // `pictures` (B x 3 x H x W): RGB in [-1, 1]; H and W multiples of the options' side_step().
  DetectorOutput Detect(const torch::Tensor& pictures);

 private:
  nn::UNet unet_{nullptr};
};
TORCH_MODULE(DetectorNetwork);

// Returns the (count x 3 x height x width) network input for RGB bytes.
torch::Tensor DetectorPictures(const std::uint8_t* rgb, int count, int height, int width);

}  // namespace simwright::twin
