#include "nn/checkpoint.h"

#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace simwright::nn {
namespace {

constexpr char kFacts[] = "facts";

torch::serialize::InputArchive Open(const std::filesystem::path& path) {
  std::istringstream bytes(core::ReadFile(path, 1ull << 32));
  torch::serialize::InputArchive archive;
  try {
    archive.load_from(bytes);
  } catch (const c10::Error&) {
    throw core::Error("is no weights file of this program, or a damaged one", path.string());
  }
  return archive;
}

// Facts as lines "key=value", kept as a tensor of bytes: the archive holds tensors.
torch::Tensor Packed(const CheckpointFacts& facts) {
  std::string text;
  for (const auto& [key, value] : facts) text += key + "=" + value + "\n";
  return torch::from_blob(text.data(), {static_cast<std::int64_t>(text.size())}, torch::kUInt8)
      .clone();
}

template <typename Visit>
void ForEachTensor(const torch::nn::Module& module, const Visit& visit) {
  for (const auto& item : module.named_parameters()) visit(item.key(), item.value());
  for (const auto& item : module.named_buffers()) visit(item.key(), item.value());
}

}  // namespace

void SaveCheckpoint(const torch::nn::Module& module, const CheckpointFacts& facts,
                    const std::filesystem::path& path) {
  if (!facts.contains("kind")) throw core::Error("a checkpoint says its kind", path.string());
  torch::serialize::OutputArchive archive;
  archive.write(kFacts, Packed(facts), true);
  ForEachTensor(module, [&](const std::string& name, const torch::Tensor& value) {
    archive.write(name, value.detach().to(torch::kCPU, torch::kHalf), true);
  });
  std::ostringstream bytes;
  archive.save_to(bytes);
  core::WriteFile(path, bytes.str());
}

CheckpointFacts ReadCheckpointFacts(const std::filesystem::path& path, const std::string& kind) {
  torch::serialize::InputArchive archive = Open(path);
  torch::Tensor packed;
  if (!archive.try_read(kFacts, packed, true) || packed.scalar_type() != torch::kUInt8) {
    throw core::Error("holds no facts: is no weights file of this program", path.string());
  }
  packed = packed.contiguous();
  std::istringstream text(std::string(reinterpret_cast<const char*>(packed.data_ptr()),
                                      static_cast<size_t>(packed.numel())));
  CheckpointFacts facts;
  for (std::string line; std::getline(text, line);) {
    const size_t equals = line.find('=');
    if (equals != std::string::npos) facts[line.substr(0, equals)] = line.substr(equals + 1);
  }
  if (facts["kind"] != kind) {
    throw core::Error("holds weights of kind '" + facts["kind"] + "', wanted is '" + kind + "'",
                      path.string());
  }
  return facts;
}

void LoadCheckpoint(const std::filesystem::path& path, torch::nn::Module* module) {
  torch::serialize::InputArchive archive = Open(path);
  const torch::NoGradGuard no_grad;
  ForEachTensor(*module, [&](const std::string& name, torch::Tensor value) {
    torch::Tensor stored;
    if (!archive.try_read(name, stored, true) || !stored.sizes().equals(value.sizes())) {
      throw core::Error("has no '" + name + "' of the network's shape: train the weights anew",
                        path.string());
    }
    value.copy_(stored);
  });
}

}  // namespace simwright::nn
