#include "core/device_choice.h"

#include <atomic>

namespace simwright::core {
namespace {

std::atomic<DeviceChoice> chosen_device{DeviceChoice::kAuto};

}  // namespace

DeviceChoice ChosenDevice() {
  return chosen_device;
}

void ChooseDevice(DeviceChoice choice) {
  chosen_device = choice;
}

}  // namespace simwright::core
