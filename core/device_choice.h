#pragma once

namespace simwright::core {

// The processor on which networks run: kAuto is a CUDA GPU if there is one, else the CPU.
enum class DeviceChoice { kAuto, kCpu, kCuda };

// Return and set the choice of this process; kAuto at the start.
DeviceChoice ChosenDevice();
void ChooseDevice(DeviceChoice choice);

}  // namespace simwright::core
