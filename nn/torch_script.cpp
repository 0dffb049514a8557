#include "nn/torch_script.h"

#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace simwright::nn {

torch::jit::script::Module LoadTorchScript(const std::filesystem::path& path) {
  std::istringstream bytes(core::ReadFile(path, 1ull << 34));
  try {
    return torch::jit::load(bytes, torch::kCPU);
  } catch (const std::exception&) {
    throw core::Error("is not a TorchScript module", path.string(),
                      "save it with torch.jit.script(model).save(FILE)");
  }
}

}  // namespace simwright::nn
