#include "nn/tensor_file.h"

#include <stdexcept>

#include "core/error.h"
#include "core/files.h"
#include "nn/tensor_bytes.h"

namespace simwright::nn {
namespace {

template <typename Visit>
void ForEachTensor(const torch::nn::Module& module, const Visit& visit) {
  for (const auto& item : module.named_parameters()) visit(item.key(), item.value());
  for (const auto& item : module.named_buffers()) visit(item.key(), item.value());
}

// Returns true if a zip archive ends with its last record, of 22 bytes without a comment: libtorch
// reads past the end of a file that was truncated within it.
bool EndsWhole(const std::string& archive) {
  constexpr std::size_t kEndRecord = 22;
  return archive.size() >= kEndRecord &&
         archive.compare(archive.size() - kEndRecord, 4, "PK\5\6") == 0;
}

}  // namespace

std::string PackTensors(const NamedTensors& tensors) {
  c10::Dict<std::string, torch::Tensor> dictionary;
  for (const auto& [name, tensor] : tensors) {
    dictionary.insert(name, tensor.detach().to(torch::kCPU).contiguous());
  }
  const std::vector<char> bytes = torch::pickle_save(dictionary);
  return {bytes.data(), bytes.size()};
}

NamedTensors UnpackTensors(const std::string& bytes, const std::string& where) {
  NamedTensors tensors;
  try {
    if (!EndsWhole(bytes)) throw std::runtime_error("truncated");
    const c10::IValue value = torch::pickle_load(std::vector<char>(bytes.begin(), bytes.end()));
    for (const auto& entry : value.toGenericDict()) {
      tensors[entry.key().toStringRef()] = entry.value().toTensor();
    }
  } catch (const std::exception&) {
    throw core::Error("is not a weights file of this program, or is damaged", where);
  }
  return tensors;
}

void WriteTensors(const NamedTensors& tensors, const std::filesystem::path& path) {
  core::WriteFile(path, PackTensors(tensors));
}

NamedTensors ReadTensors(const std::filesystem::path& path) {
  return UnpackTensors(core::ReadFile(path, 1ull << 34), path.string());
}

void CollectTensors(const torch::nn::Module& module, const std::string& prefix,
                    NamedTensors* tensors) {
  ForEachTensor(module, [&](const std::string& name, const torch::Tensor& value) {
    (*tensors)[prefix + name] = value;
  });
}

std::string RestoreTensors(const NamedTensors& tensors, const std::string& prefix,
                           torch::nn::Module* module) {
  const torch::NoGradGuard no_grad;
  std::string missing;
  ForEachTensor(*module, [&](const std::string& name, torch::Tensor value) {
    const auto found = tensors.find(prefix + name);
    if (found == tensors.end() || !found->second.sizes().equals(value.sizes())) {
      if (missing.empty()) missing = name;
      return;
    }
    value.copy_(found->second);
  });
  return missing;
}

}  // namespace simwright::nn
