#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "nn/torch.h"
#include "twin/detector_example.h"

namespace simwright::twin {

// Pictures and what the network shall tell from them.
struct DetectorBatch {
  torch::Tensor pictures;  // (B x 3 x H x W)
  torch::Tensor object;    // (B x 1 x H x W) 1: an object
  torch::Tensor known;     // (B x 1 x H x W) 0: left out
  torch::Tensor centre;    // (B x 1 x H x W) heat in [0, 1]
  torch::Tensor offset;    // (B x 2 x H x W)
};

// Returns the batch of B pictures of `width` x `height` pixels. A share `part_share` of them shows
// only a part of its picture, enlarged.
DetectorBatch BatchOf(const std::vector<const DetectorExample*>& examples, int width, int height,
                      double part_share, core::Rng* rng);

// Moves a batch to a device.
void MoveBatch(const torch::Device& device, DetectorBatch* batch);

// Returns pictures `first` to `first` + `count` - 1 of a batch.
DetectorBatch PartOfBatch(const DetectorBatch& batch, std::int64_t first, std::int64_t count);

// Mirrors a part of the pictures, and changes colours as cameras do: exposure, white balance,
// contrast, blur and noise.
void AugmentBatch(DetectorBatch* batch);

}  // namespace simwright::twin
