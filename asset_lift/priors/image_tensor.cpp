#include "asset_lift/priors/image_tensor.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::asset_lift {

torch::Tensor TensorFromImage(const core::FloatImage& image) {
  return torch::from_blob(const_cast<float*>(image.values.data()),
                          {1, image.height, image.width, image.channels}, torch::kFloat)
      .permute({0, 3, 1, 2})
      .clone(at::MemoryFormat::Contiguous);
}

void ImageFromTensor(const torch::Tensor& planes, int first_channel, core::FloatImage* image) {
  if (planes.dim() != 4 || planes.size(1) < first_channel + image->channels ||
      planes.size(2) != image->height || planes.size(3) != image->width) {
    throw core::Error("a tensor and its image differ in size");
  }
  const torch::Tensor rows = planes[0]
                                 .slice(0, first_channel, first_channel + image->channels)
                                 .permute({1, 2, 0})
                                 .to(torch::kCPU, torch::kFloat)
                                 .contiguous();
  std::copy_n(rows.data_ptr<float>(), image->values.size(), image->values.begin());
}

}  // namespace simwright::asset_lift
