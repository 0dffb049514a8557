#include "nn/checkpoint.h"

#include <sstream>

#include "core/error.h"
#include "nn/tensor_file.h"

namespace simwright::nn {
namespace {

constexpr char kMetadataKey[] = "facts";
// A matrix NAME in eight bits is stored as NAME.rows8 and NAME.row_scale, so that programs that do
// not know them find no NAME.
constexpr char kRowsSuffix[] = ".rows8", kScaleSuffix[] = ".row_scale";
constexpr std::int64_t kLargeMatrix = 4096;  // elements

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

// Stores the tensor, of two or more dimensions, as 8-bit integers; a row has one index of the first
// dimension.
void StoreInEightBits(const std::string& name, const torch::Tensor& tensor, NamedTensors* tensors) {
  const torch::Tensor rows = tensor.detach().to(torch::kFloat).reshape({tensor.size(0), -1});
  const torch::Tensor scale = rows.abs().amax(1, /*keepdim=*/true) / 127.0f;
  const torch::Tensor safe = torch::where(scale > 0.0f, scale, torch::ones_like(scale));
  (*tensors)[name + kRowsSuffix] =
      (rows / safe).round().clamp(-127, 127).to(torch::kChar).reshape(tensor.sizes());
  (*tensors)[name + kScaleSuffix] = scale.squeeze(1);
}

// Adds the matrices that are stored in eight bits.
void AddEightBits(NamedTensors* tensors) {
  NamedTensors expanded;
  for (const auto& [stored, tensor] : *tensors) {
    if (!stored.ends_with(kRowsSuffix)) continue;
    const std::string name = stored.substr(0, stored.size() - sizeof kRowsSuffix + 1);
    const auto scale = tensors->find(name + kScaleSuffix);
    if (scale == tensors->end() || tensor.scalar_type() != torch::kChar || tensor.dim() < 1 ||
        scale->second.numel() != tensor.size(0)) {
      continue;
    }
    const torch::Tensor rows = tensor.to(torch::kFloat).reshape({tensor.size(0), -1});
    expanded[name] =
        (rows * scale->second.to(torch::kFloat).reshape({-1, 1})).reshape(tensor.sizes());
  }
  tensors->merge(expanded);
}

}  // namespace

void SaveCheckpoint(const torch::nn::Module& module, const CheckpointMetadata& metadata,
                    const std::filesystem::path& path, StoredPrecision precision) {
  if (!metadata.contains("kind"))
    throw core::Error("a checkpoint must state its kind", path.string());
  NamedTensors whole, tensors;
  CollectTensors(module, "", &whole);
  for (const auto& [name, tensor] : whole) {
    const bool large = tensor.dim() >= 2 && tensor.numel() >= kLargeMatrix;
    if (precision == StoredPrecision::kEightBits && large) {
      StoreInEightBits(name, tensor, &tensors);
    } else {
      tensors[name] = tensor.detach().to(torch::kHalf);
    }
  }
  tensors[kMetadataKey] = Packed(metadata);
  WriteTensors(tensors, path);
}

CheckpointMetadata ReadCheckpointMetadata(const std::filesystem::path& path,
                                          const std::string& kind) {
  return MetadataOf(ReadTensors(path), kind, path);
}

CheckpointMetadata LoadCheckpoint(const std::filesystem::path& path, const std::string& kind,
                                  torch::nn::Module* module) {
  NamedTensors tensors = ReadTensors(path);
  const CheckpointMetadata metadata = MetadataOf(tensors, kind, path);
  AddEightBits(&tensors);
  const std::string missing = RestoreTensors(tensors, "", module);
  if (!missing.empty()) {
    throw core::Error("has no '" + missing + "' of the network's shape", path.string(),
                      "train the weights again");
  }
  return metadata;
}

}  // namespace simwright::nn
