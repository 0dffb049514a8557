#include "asset_lift/segmentation/network_formats.h"

#include <sstream>

#include "core/error.h"
#include "nn/compute.h"
#include "nn/torch_script.h"

namespace simwright::asset_lift {
namespace {

// Returns the first tensor of a network's output: itself, or the first of a tuple or list.
std::optional<torch::Tensor> FirstTensor(const c10::IValue& output) {
  if (output.isTensor()) return output.toTensor();
  if (output.isTensorList()) {
    const std::vector<torch::Tensor> tensors = output.toTensorVector();
    if (!tensors.empty()) return tensors.front();
  }
  if (output.isTuple() && !output.toTupleRef().elements().empty()) {
    return FirstTensor(output.toTupleRef().elements()[0]);
  }
  return std::nullopt;
}

// Returns the module's attribute `side`, or `otherwise`. Throws unless it is 16 to 4096.
int SideOf(const torch::jit::script::Module& module, const std::string& where, int otherwise) {
  if (!module.hasattr("side")) return otherwise;
  const c10::IValue value = module.attr("side");
  const std::int64_t side = value.isInt() ? value.toInt() : 0;
  if (side >= 16 && side <= 4096) return static_cast<int>(side);
  throw core::Error("its attribute `side` is no whole number from 16 to 4096", where,
                    "correct it, or give --segmenter-size");
}

class ScriptedNetwork final : public SalientNetwork {
 public:
  ScriptedNetwork(torch::jit::script::Module module, const std::filesystem::path& file, int side,
                  InputNormalisation normalisation)
      : SalientNetwork(file, side, normalisation),
        module_(std::move(module)),
        device_(nn::BestDevice()) {
    module_.eval();
    module_.to(device_);
  }

 protected:
  SaliencyMap Run(const std::vector<float>& input) override {
    const torch::NoGradGuard no_grad;
    std::optional<torch::Tensor> output;
    try {
      const torch::Tensor tensor =
          torch::from_blob(const_cast<float*>(input.data()), {1, 3, side(), side()}, torch::kFloat);
      output = FirstTensor(module_.forward({tensor.to(device_)}));
      if (output) output = output->to(torch::kCPU, torch::kFloat).contiguous();
    } catch (const std::exception& error) {
      const std::string reason = error.what();
      throw core::Error("the network does not run on an input of 1 x 3 x " +
                            std::to_string(side()) + " x " + std::to_string(side()) + ": " +
                            reason.substr(0, std::min<size_t>(reason.find('\n'), 200)),
                        where(), kExpectedSignature);
    }
    if (!output) throw core::Error("the network returns no tensor", where(), kExpectedSignature);
    if (output->dim() != 4 || output->size(0) != 1 || output->size(1) != 1 ||
        output->numel() == 0) {
      std::ostringstream shape;
      shape << output->sizes();
      throw core::Error("the network's first output is " + shape.str(), where(),
                        kExpectedSignature);
    }
    const float* values = output->data_ptr<float>();
    return {static_cast<int>(output->size(3)),
            static_cast<int>(output->size(2)),
            {values, values + output->numel()}};
  }

 private:
  torch::jit::script::Module module_;
  torch::Device device_;
};

}  // namespace

std::shared_ptr<SalientNetwork> LoadScriptedNetwork(const std::filesystem::path& file,
                                                    const SalientNetworkOptions& options) {
  constexpr int kUsualSide = 320;  // of U2-Net
  torch::jit::script::Module module = nn::LoadTorchScript(file);
  const int side = options.side != 0 ? options.side : SideOf(module, file.string(), kUsualSide);
  return std::make_shared<ScriptedNetwork>(std::move(module), file, side, options.normalisation);
}

}  // namespace simwright::asset_lift
