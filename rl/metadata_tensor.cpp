#include "rl/metadata_tensor.h"

#include <cstring>
#include <sstream>

#include "core/error.h"

namespace simwright::rl {

torch::Tensor PackBytes(const std::string& bytes) {
  torch::Tensor tensor =
      torch::empty({static_cast<std::int64_t>(bytes.size())}, torch::TensorOptions(torch::kUInt8));
  if (!bytes.empty()) std::memcpy(tensor.data_ptr(), bytes.data(), bytes.size());
  return tensor;
}

std::string UnpackBytes(const torch::Tensor& tensor) {
  if (!tensor.defined() || tensor.scalar_type() != torch::kUInt8) {
    throw core::Error("has a tensor that holds no bytes");
  }
  const torch::Tensor packed = tensor.contiguous();
  return {static_cast<const char*>(packed.data_ptr()), static_cast<std::size_t>(packed.numel())};
}

torch::Tensor PackMetadata(const Metadata& metadata) {
  std::string text;
  for (const auto& [key, value] : metadata) {
    if (key.find_first_of("=\n") != std::string::npos || value.find('\n') != std::string::npos) {
      throw core::Error("a metadata entry must be one line, without '=' in its key", key);
    }
    text += key + "=" + value + "\n";
  }
  return PackBytes(text);
}

Metadata UnpackMetadata(const torch::Tensor& tensor) {
  std::istringstream text(UnpackBytes(tensor));
  Metadata metadata;
  for (std::string line; std::getline(text, line);) {
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos) metadata[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return metadata;
}

torch::Tensor TakeTensor(const nn::NamedTensors& tensors, const std::string& name,
                         torch::ScalarType type, std::int64_t dimensions) {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw core::Error("has no '" + name + "'");
  if (found->second.scalar_type() != type || found->second.dim() != dimensions) {
    throw core::Error("has a '" + name + "' of another type or shape");
  }
  return found->second.contiguous();
}

}  // namespace simwright::rl
