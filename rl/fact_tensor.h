#pragma once

#include <string>

#include "nn/tensor_file.h"
#include "rl/policy.h"

namespace simwright::rl {

// Bytes as a tensor (uint8), so that a file of tensors holds them too.
torch::Tensor PackBytes(const std::string& bytes);
// Throws core::Error where `tensor` holds no bytes.
std::string UnpackBytes(const torch::Tensor& tensor);

// Facts as lines "key=value". Throws core::Error for a key or value that would break a line.
torch::Tensor PackFacts(const Facts& facts);
Facts UnpackFacts(const torch::Tensor& tensor);

// The tensor of that name, type and number of dimensions. Throws core::Error where it is missing
// or another.
torch::Tensor TakeTensor(const nn::NamedTensors& tensors, const std::string& name,
                         torch::ScalarType type, std::int64_t dimensions);

}  // namespace simwright::rl
