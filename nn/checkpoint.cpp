#include "nn/checkpoint.h"

#include <sstream>

#include "core/error.h"
#include "nn/tensor_file.h"

namespace simwright::nn {
namespace {

constexpr char kFacts[] = "facts";

// Encodes the metadata as lines "key=value" in a tensor of bytes: the file holds only tensors.
torch::Tensor Packed(const CheckpointMetadata& facts) {
  std::string text;
  for (const auto& [key, value] : facts) text += key + "=" + value + "\n";
  return torch::from_blob(text.data(), {static_cast<std::int64_t>(text.size())}, torch::kUInt8)
      .clone();
}

CheckpointMetadata FactsOf(const NamedTensors& tensors, const std::string& kind,
                           const std::filesystem::path& path) {
  const auto found = tensors.find(kFacts);
  if (found == tensors.end() || found->second.scalar_type() != torch::kUInt8) {
    throw core::Error("has no metadata: not a weights file of this program", path.string());
  }
  const torch::Tensor packed = found->second.contiguous();
  std::istringstream text(std::string(reinterpret_cast<const char*>(packed.data_ptr()),
                                      static_cast<size_t>(packed.numel())));
  CheckpointMetadata facts;
  for (std::string line; std::getline(text, line);) {
    const size_t equals = line.find('=');
    if (equals != std::string::npos) facts[line.substr(0, equals)] = line.substr(equals + 1);
  }
  if (facts["kind"] != kind) {
    throw core::Error("holds weights of kind '" + facts["kind"] + "', expected '" + kind + "'",
                      path.string());
  }
  return facts;
}

}  // namespace

void SaveCheckpoint(const torch::nn::Module& module, const CheckpointMetadata& facts,
                    const std::filesystem::path& path) {
  if (!facts.contains("kind")) throw core::Error("a checkpoint must state its kind", path.string());
  NamedTensors tensors;
  CollectTensors(module, "", &tensors);
  for (auto& [name, tensor] : tensors) tensor = tensor.detach().to(torch::kHalf);
  tensors[kFacts] = Packed(facts);
  WriteTensors(tensors, path);
}

CheckpointMetadata ReadCheckpointMetadata(const std::filesystem::path& path,
                                          const std::string& kind) {
  return FactsOf(ReadTensors(path), kind, path);
}

CheckpointMetadata LoadCheckpoint(const std::filesystem::path& path, const std::string& kind,
                                  torch::nn::Module* module) {
  const NamedTensors tensors = ReadTensors(path);
  const CheckpointMetadata facts = FactsOf(tensors, kind, path);
  const std::string missing = RestoreTensors(tensors, "", module);
  if (!missing.empty()) {
    throw core::Error("has no '" + missing + "' of the network's shape", path.string(),
                      "train the weights again");
  }
  return facts;
}

}  // namespace simwright::nn
