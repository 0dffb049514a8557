#pragma once

#include "core/float_image.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// (1 x C x H x W) float32 of a picture; a copy, on the CPU.
torch::Tensor TensorFromImage(const core::FloatImage& image);

// Fills `image` from its own number of channels of `planes` (1 x C x H x W), from `first_channel`
// on. Throws core::Error where the sizes do not fit.
void ImageFromTensor(const torch::Tensor& planes, int first_channel, core::FloatImage* image);

}  // namespace simwright::asset_lift
