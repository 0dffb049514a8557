#include <torch/version.h>

#include "core/error.h"
#include "nn/parameter_update.h"

// libtorch 2.4 has the fused AdamW on CPUs too, where it is tested.
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
#define SIMWRIGHT_TORCH_HAS_FUSED_ADAMW
#endif

namespace simwright::nn {

#ifdef SIMWRIGHT_TORCH_HAS_FUSED_ADAMW
namespace {

using torch::optim::AdamWOptions;

constexpr double kNormMargin = 1e-6;  // as in torch::nn::utils::clip_grad_norm_

// All numbers that change from step to step are tensors on the parameters' device, so that nothing
// waits for it and a step can be captured in a CUDA graph.
class FusedUpdate : public ParameterUpdate {
 public:
  FusedUpdate(torch::nn::Module* module, const TrainerOptions& options)
      : parameters_(module->parameters()),
        options_(options),
        rate_(Number(0.0, torch::kFloat)),
        updates_(Number(0.0, torch::kDouble)),
        skipped_(Number(0.0, torch::kFloat)) {
    const torch::NoGradGuard no_gradient;
    for (const torch::Tensor& one : parameters_) {
      average_.push_back(one.detach().clone());
      first_.push_back(torch::zeros_like(one));
      second_.push_back(torch::zeros_like(one));
      steps_.push_back(Number(0.0, torch::kFloat));
    }
  }

  bool ChecksLoss() const override { return true; }
  void ClearGradients() override {
    for (torch::Tensor& one : parameters_) one.mutable_grad() = torch::Tensor();
  }
  void SetRate(double rate) override { rate_.fill_(rate); }

  void Apply(const torch::Tensor& loss) override {
    const torch::NoGradGuard no_gradient;
    const Lists lists = ListsWithGradients();
    if (lists.parameters.empty()) return;
    const torch::Tensor norm =
        at::linalg_vector_norm(torch::stack(at::_foreach_norm(lists.gradients, 2.0)));
    torch::Tensor is_finite = torch::isfinite(norm);
    if (loss.defined()) is_finite = is_finite.logical_and(torch::isfinite(loss.detach()));
    const torch::Tensor taken = is_finite.to(torch::kFloat), left_out = 1.0 - taken;
    // The kernel divides the gradients by this.
    const torch::Tensor scale = ((norm + kNormMargin) / options_.largest_norm).clamp_min(1.0);
    at::_foreach_add_(lists.steps, taken);
    const AdamWOptions adam;
    at::_fused_adamw_(lists.parameters, lists.gradients, lists.first, lists.second, {}, lists.steps,
                      rate_, std::get<0>(adam.betas()), std::get<1>(adam.betas()),
                      options_.weight_decay, adam.eps(), /*amsgrad=*/false, /*maximize=*/false,
                      scale.to(torch::kFloat), left_out);
    UpdateAverage(taken);
    skipped_.add_(1.0).mul_(left_out);
  }

  int SkippedInARow() const override { return static_cast<int>(skipped_.item<float>()); }

  void CopyAverageTo(torch::nn::Module* module) const override {
    const torch::NoGradGuard no_gradient;
    const std::vector<torch::Tensor> to = module->parameters();
    for (size_t i = 0; i < to.size(); ++i) to[i].copy_(average_[i]);
  }

  void Collect(NamedTensors* tensors) const override {
    (*tensors)["average.updates"] = updates_.to(torch::kLong);
    for (size_t i = 0; i < parameters_.size(); ++i) {
      (*tensors)["average." + std::to_string(i)] = average_[i];
      if (steps_[i].item<float>() == 0.0f) continue;
      const std::string name = "adam." + std::to_string(i);
      (*tensors)[name + ".step"] = steps_[i].to(torch::kLong);
      (*tensors)[name + ".first"] = first_[i];
      (*tensors)[name + ".second"] = second_[i];
    }
  }

  bool Load(const NamedTensors& tensors) override {
    const torch::NoGradGuard no_gradient;
    if (!CopyNamed(tensors, "average.updates", &updates_)) return false;
    for (size_t i = 0; i < parameters_.size(); ++i) {
      if (!CopyNamed(tensors, "average." + std::to_string(i), &average_[i])) return false;
      const std::string name = "adam." + std::to_string(i);
      if (!tensors.contains(name + ".step")) continue;
      if (!CopyNamed(tensors, name + ".step", &steps_[i]) ||
          !CopyNamed(tensors, name + ".first", &first_[i]) ||
          !CopyNamed(tensors, name + ".second", &second_[i])) {
        return false;
      }
    }
    return true;
  }

 private:
  // The tensors of the parameters that have a gradient.
  struct Lists {
    std::vector<torch::Tensor> parameters, gradients, first, second, steps;
  };

  torch::Tensor Number(double value, torch::ScalarType type) const {
    if (parameters_.empty()) throw core::Error("the module has no parameters");
    return torch::full({}, value, parameters_.front().options().dtype(type).requires_grad(false));
  }

  static bool CopyNamed(const NamedTensors& tensors, const std::string& name, torch::Tensor* to) {
    const auto found = tensors.find(name);
    if (found == tensors.end() || !found->second.sizes().equals(to->sizes())) return false;
    to->copy_(found->second);
    return true;
  }

  // Returns the gradient in the parameter's layout, which the kernel assumes and autograd's
  // functions do not give.
  static torch::Tensor InLayoutOf(const torch::Tensor& parameter, const torch::Tensor& gradient) {
    if (gradient.strides().equals(parameter.strides())) return gradient;
    return torch::empty_like(parameter).copy_(gradient);
  }

  Lists ListsWithGradients() const {
    Lists lists;
    for (size_t i = 0; i < parameters_.size(); ++i) {
      if (!parameters_[i].grad().defined()) continue;
      lists.parameters.push_back(parameters_[i]);
      lists.gradients.push_back(InLayoutOf(parameters_[i], parameters_[i].grad()));
      lists.first.push_back(first_[i]);
      lists.second.push_back(second_[i]);
      lists.steps.push_back(steps_[i]);
    }
    return lists;
  }

  // The average moves by the share that Ema takes after as many updates; not at all if `taken` is
  // 0.
  void UpdateAverage(const torch::Tensor& taken) {
    const torch::Tensor decay =
        ((updates_ + 1.0) / (updates_ + 10.0)).clamp_max(options_.ema_decay);
    const torch::Tensor share = ((1.0 - decay) * taken).to(torch::kFloat);
    std::vector<torch::Tensor> off = at::_foreach_sub(parameters_, average_);
    at::_foreach_mul_(off, share);
    at::_foreach_add_(average_, off);
    updates_.add_(taken);
  }

  std::vector<torch::Tensor> parameters_, average_, first_, second_;
  std::vector<torch::Tensor> steps_;  // of each parameter; without dimensions, like those below
  TrainerOptions options_;
  torch::Tensor rate_, updates_, skipped_;  // updates_: of the average
};

}  // namespace

bool HasFusedUpdate() {
  return true;
}

std::unique_ptr<ParameterUpdate> MakeFusedUpdate(torch::nn::Module* module,
                                                 const TrainerOptions& options) {
  return std::make_unique<FusedUpdate>(module, options);
}

#else

bool HasFusedUpdate() {
  return false;
}

std::unique_ptr<ParameterUpdate> MakeFusedUpdate(torch::nn::Module*, const TrainerOptions&) {
  throw core::Error("this libtorch has no fused optimizer", "training",
                    "build with libtorch 2.4 or later");
}

#endif

}  // namespace simwright::nn
