#include "nn/device_table.h"

#include <mutex>

namespace simwright::nn {

struct DeviceTable::Copy {
  std::mutex mutex;
  torch::Tensor values;  // on the device that was asked for last, which is no CPU
};

DeviceTable::DeviceTable(const torch::Tensor& values)
    : values_(values.contiguous()), copy_(std::make_shared<Copy>()) {}

torch::Tensor DeviceTable::On(const torch::Device& device) const {
  if (device.is_cpu()) return values_;
  const std::lock_guard lock(copy_->mutex);
  if (!copy_->values.defined() || copy_->values.device() != device) {
    copy_->values = values_.to(device);
  }
  return copy_->values;
}

}  // namespace simwright::nn
