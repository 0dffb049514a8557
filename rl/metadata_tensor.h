#pragma once

#include <string>

#include "nn/tensor_file.h"
#include "rl/policy.h"

namespace simwright::rl {

// Packs bytes into a tensor (uint8), so that they can be stored in a file of tensors.
torch::Tensor PackBytes(const std::string& bytes);
// Throws core::Error if `tensor` holds no bytes.
std::string UnpackBytes(const torch::Tensor& tensor);

// Packs metadata as lines "key=value". Throws core::Error for a key or value that would break a
// line.
torch::Tensor PackMetadata(const Metadata& metadata);
Metadata UnpackMetadata(const torch::Tensor& tensor);

// Returns the tensor of that name, type and number of dimensions. Throws core::Error if it is
// missing or differs.
torch::Tensor TakeTensor(const nn::NamedTensors& tensors, const std::string& name,
                         torch::ScalarType type, std::int64_t dimensions);

}  // namespace simwright::rl
