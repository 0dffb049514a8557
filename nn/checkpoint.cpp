#include "nn/checkpoint.h"

#include <sstream>

#include "core/error.h"
#include "nn/tensor_file.h"

namespace simwright::nn {
namespace {

constexpr char kMetadataKey[] = "facts";

// Encodes the metadata as lines "key=value" in a tensor of bytes: the file holds only tensors.
torch::Tensor Packed(const CheckpointMetadata& metadata) {
  std::string text;
  for (const auto& [key, value] : metadata) text += key + "=" + value + "\n";
  return torch::from_blob(text.data(), {static_cast<std::int64_t>(text.size())}, torch::kUInt8)
      .clone();
}

CheckpointMetadata MetadataOf(const NamedTensors& tensors, const std::string& kind,
                              const std::filesystem::path& path) {
  const auto found = tensors.find(kMetadataKey);
  if (found == tensors.end() || found->second.scalar_type() != torch::kUInt8) {
    throw core::Error("has no metadata: not a weights file of this program", path.string());
  }
  const torch::Tensor packed = found->second.contiguous();
  std::istringstream text(std::string(reinterpret_cast<const char*>(packed.data_ptr()),
                                      static_cast<size_t>(packed.numel())));
  CheckpointMetadata metadata;
  for (std::string line; std::getline(text, line);) {
    const size_t equals = line.find('=');
    if (equals != std::string::npos) metadata[line.substr(0, equals)] = line.substr(equals + 1);
  }
  if (metadata["kind"] != kind) {
    throw core::Error("holds weights of kind '" + metadata["kind"] + "', expected '" + kind + "'",
                      path.string());
  }
  return metadata;
}

}  // namespace

void SaveCheckpoint(const torch::nn::Module& module, const CheckpointMetadata& metadata,
                    const std::filesystem::path& path) {
  if (!metadata.contains("kind"))
    throw core::Error("a checkpoint must state its kind", path.string());
  NamedTensors tensors;
  CollectTensors(module, "", &tensors);
  for (auto& [name, tensor] : tensors) tensor = tensor.detach().to(torch::kHalf);
  tensors[kMetadataKey] = Packed(metadata);
  WriteTensors(tensors, path);
}

CheckpointMetadata ReadCheckpointMetadata(const std::filesystem::path& path,
                                          const std::string& kind) {
  return MetadataOf(ReadTensors(path), kind, path);
}

CheckpointMetadata LoadCheckpoint(const std::filesystem::path& path, const std::string& kind,
                                  torch::nn::Module* module) {
  const NamedTensors tensors = ReadTensors(path);
  const CheckpointMetadata metadata = MetadataOf(tensors, kind, path);
  const std::string missing = RestoreTensors(tensors, "", module);
  if (!missing.empty()) {
    throw core::Error("has no '" + missing + "' of the network's shape", path.string(),
                      "train the weights again");
  }
  return metadata;
}

}  // namespace simwright::nn
