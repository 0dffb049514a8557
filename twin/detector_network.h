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
// The camera's numbers: elevation and roll (rad), logarithms of the focal length over the picture's
// width and of the height above the table (m).
inline constexpr int kCameraNumbers = 4;

// The network's answer for B pictures of H x W pixels.
struct DetectorOutput {
  torch::Tensor object;  // (B x 1 x H x W) logits: the pixel shows an object
  torch::Tensor centre;  // (B x 1 x H x W) logits of the heat around the objects' centres
  torch::Tensor offset;  // (B x 2 x H x W) from the pixel to its object's centre, kOffsetUnit
  torch::Tensor camera;  // (B x 4) means
  torch::Tensor log_b;   // (B x 4) logarithms of the mean absolute errors
};

// Returns the entries of a weights' file that state the sizes.
nn::CheckpointMetadata MetadataOf(const DetectorNetworkOptions& options);
// Reads the sizes from the file `weights`. Throws core::Error for a file without valid ones.
DetectorNetworkOptions ReadDetectorSizes(const std::filesystem::path& weights);

// Tells the camera from a picture and the objects in it.
class CameraNetworkImpl : public torch::nn::Module {
 public:
  CameraNetworkImpl();
  // Returns (B x 2 kCameraNumbers) means, and logarithms of mean absolute errors, for `seen` (B x 4
  // x H x W): the picture, and the probability that a pixel shows an object.
  torch::Tensor forward(const torch::Tensor& seen);

 private:
  torch::nn::Sequential features_{nullptr};
  torch::nn::Linear hidden_{nullptr}, numbers_{nullptr};
};
TORCH_MODULE(CameraNetwork);

// Finds the objects on a table: a U-Net tells for each pixel whether it shows an object, and where
// the middle of that object is (Cheng et al. 2020, "Panoptic-DeepLab"). A second network tells the
// camera above the table.
class DetectorNetworkImpl : public torch::nn::Module {
 public:
  explicit DetectorNetworkImpl(const DetectorNetworkOptions& options = {});

  // `pictures` (B x 3 x H x W): RGB in [-1, 1]; H and W multiples of the options' side_step().
  DetectorOutput Detect(const torch::Tensor& pictures);
  // Tells the pixels alone; `camera` and `log_b` stay undefined.
  DetectorOutput DetectPixels(const torch::Tensor& pictures);

  torch::nn::Module* pixel_part() { return unet_.get(); }
  torch::nn::Module* camera_part() { return camera_.get(); }

 private:
  nn::UNet unet_{nullptr};
  CameraNetwork camera_{nullptr};
};
TORCH_MODULE(DetectorNetwork);

// Returns the (count x 3 x height x width) network input for RGB bytes.
torch::Tensor DetectorPictures(const std::uint8_t* rgb, int count, int height, int width);

}  // namespace simwright::twin
