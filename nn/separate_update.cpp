#include <sstream>
#include <type_traits>

#include "nn/compute.h"
#include "nn/ema.h"
#include "nn/parameter_update.h"

namespace simwright::nn {
namespace {

using torch::optim::AdamWOptions;
using torch::optim::AdamWParamState;

// Returns the key of a parameter in an optimizer's states: its address, which libtorch writes as
// text up to 2.0 and as a pointer from 2.1 on.
template <typename States>
typename States::key_type StateKey(const States&, const torch::Tensor& parameter) {
  c10::TensorImpl* const address = parameter.unsafeGetTensorImpl();
  if constexpr (std::is_same_v<typename States::key_type, std::string>) {
    std::ostringstream text;
    text << address;
    return text.str();
  } else {
    return address;
  }
}

// libtorch's AdamW and our average, parameter by parameter.
class SeparateUpdate : public ParameterUpdate {
 public:
  SeparateUpdate(torch::nn::Module* module, const TrainerOptions& options)
      : module_(module),
        largest_norm_(options.largest_norm),
        optimizer_(module->parameters(),
                   AdamWOptions(options.learning_rate).weight_decay(options.weight_decay)),
        average_(*module, options.ema_decay) {}

  bool ChecksLoss() const override { return false; }
  void ClearGradients() override { optimizer_.zero_grad(); }
  void SetRate(double rate) override {
    for (auto& group : optimizer_.param_groups()) {
      static_cast<AdamWOptions&>(group.options()).lr(rate);
    }
  }
  void Apply(const torch::Tensor&) override {
    const SingleThreadedLoops alone;
    torch::nn::utils::clip_grad_norm_(module_->parameters(), largest_norm_);
    optimizer_.step();
    average_.Update(*module_);
  }
  int SkippedInARow() const override { return 0; }
  void CopyAverageTo(torch::nn::Module* module) const override { average_.CopyTo(module); }

  void Collect(NamedTensors* tensors) const override {
    average_.Collect(tensors);
    // AdamW's moments, in the order of the parameters.
    const std::vector<torch::Tensor> parameters = module_->parameters();
    for (size_t i = 0; i < parameters.size(); ++i) {
      const auto found = optimizer_.state().find(StateKey(optimizer_.state(), parameters[i]));
      if (found == optimizer_.state().end()) continue;
      const auto& moments = static_cast<const AdamWParamState&>(*found->second);
      const std::string name = "adam." + std::to_string(i);
      (*tensors)[name + ".step"] = torch::tensor(moments.step());
      (*tensors)[name + ".first"] = moments.exp_avg();
      (*tensors)[name + ".second"] = moments.exp_avg_sq();
    }
  }
  bool Load(const NamedTensors& tensors) override {
    if (!average_.Load(tensors)) return false;
    const std::vector<torch::Tensor> parameters = module_->parameters();
    for (size_t i = 0; i < parameters.size(); ++i) {
      const std::string name = "adam." + std::to_string(i);
      if (!tensors.contains(name + ".step")) continue;
      auto moments = std::make_unique<AdamWParamState>();
      moments->step(tensors.at(name + ".step").item<std::int64_t>());
      moments->exp_avg(tensors.at(name + ".first").to(parameters[i].device()));
      moments->exp_avg_sq(tensors.at(name + ".second").to(parameters[i].device()));
      optimizer_.state()[StateKey(optimizer_.state(), parameters[i])] = std::move(moments);
    }
    return true;
  }

 private:
  torch::nn::Module* module_;
  double largest_norm_;
  torch::optim::AdamW optimizer_;
  Ema average_;
};

}  // namespace

std::unique_ptr<ParameterUpdate> MakeSeparateUpdate(torch::nn::Module* module,
                                                    const TrainerOptions& options) {
  return std::make_unique<SeparateUpdate>(module, options);
}

}  // namespace simwright::nn
