#pragma once

#include "core/float_image.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// Returns a (1 x C x H x W) float32 copy of an image, on the CPU.
torch::Tensor TensorFromImage(const core::FloatImage& image);

// Fills `image` with its number of channels of `planes` (1 x C x H x W), starting at
// `first_channel`. Throws core::Error where the sizes do not match.
void ImageFromTensor(const torch::Tensor& planes, int first_channel, core::FloatImage* image);

}  // namespace simwright::asset_lift
