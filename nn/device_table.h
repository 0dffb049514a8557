#pragma once

#include <memory>

#include "nn/torch.h"

namespace simwright::nn {

// A table of constants for networks on any device. It is copied to a GPU once, when it is first
// used there, instead of at each use.
class DeviceTable {
 public:
  // `values` (N) float64, on the CPU.
  explicit DeviceTable(const torch::Tensor& values);

  std::int64_t size() const { return values_.size(0); }
  // Returns the value at `i`, which must lie in [0, size()).
  double At(std::int64_t i) const { return values_.data_ptr<double>()[i]; }
  // Returns the table on `device`. Thread-safe.
  torch::Tensor On(const torch::Device& device) const;

 private:
  struct Copy;

  torch::Tensor values_;
  std::shared_ptr<Copy> copy_;  // shared by copies of this object
};

}  // namespace simwright::nn
