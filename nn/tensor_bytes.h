#pragma once

#include <string>

#include "nn/tensor_file.h"

namespace simwright::nn {

// Packs tensors as a file of WriteTensors holds them, and unpacks them. UnpackTensors throws
// core::Error, naming `where`, for other bytes.
std::string PackTensors(const NamedTensors& tensors);
NamedTensors UnpackTensors(const std::string& bytes, const std::string& where);

}  // namespace simwright::nn
