#include "rl/policy_torch_script.h"

#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "nn/torch_script.h"

namespace simwright::rl {
namespace {

torch::Tensor CopyOf(const Rows& rows) {
  return torch::from_blob(const_cast<float*>(rows.data()), {rows.rows(), rows.cols()}).clone();
}

// Returns the source of `forward`.
std::string ForwardSource(const Policy& policy) {
  const Mlp& actor = policy.actor();
  std::ostringstream source;
  source << "def forward(self, observation: Tensor) -> Tensor:\n"
         << "    x = (observation - self.mean) * self.factor\n"
         << "    x = torch.where(torch.isfinite(x), x, torch.zeros_like(x))\n"
         << "    x = torch.clamp(x, -" << ObservationScale::kLimit << ".0, "
         << ObservationScale::kLimit << ".0)\n";
  for (size_t i = 0; i < actor.layers().size(); ++i) {
    source << "    x = torch.addmm(self.bias_" << i << ", x, self.weights_" << i << ")\n";
    if (i + 1 == actor.layers().size()) break;
    source << (actor.activation() == Activation::kTanh ? "    x = torch.tanh(x)\n"
                                                       : "    x = torch.elu(x)\n");
  }
  source << "    return torch.clamp(x, -1.0, 1.0)\n";
  return source.str();
}

}  // namespace

void WriteTorchScript(const Policy& policy, const Metadata& metadata,
                      const std::filesystem::path& path) {
  torch::jit::script::Module module("Policy");
  module.register_buffer("mean", CopyOf(policy.scale().mean()));
  module.register_buffer("factor", CopyOf(policy.scale().factor()));
  const std::vector<Mlp::Layer>& layers = policy.actor().layers();
  for (size_t i = 0; i < layers.size(); ++i) {
    module.register_buffer("weights_" + std::to_string(i), CopyOf(layers[i].weights));
    module.register_buffer("bias_" + std::to_string(i), CopyOf(layers[i].bias));
  }
  std::ostringstream archive;
  try {
    module.define(ForwardSource(policy));
    module.eval();
    core::Json text = core::Json::object();
    for (const auto& [key, value] : metadata) text[key] = value;
    module.save(archive, {{"metadata.json", core::JsonText(text)}});
  } catch (const c10::Error& error) {
    throw core::Error(error.what_without_backtrace(), path.string());
  }
  core::WriteFile(path, archive.str());
}

}  // namespace simwright::rl
