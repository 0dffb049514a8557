#include "nn/trainer.h"

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "nn/compute.h"
#include "nn/tensor_file.h"

namespace simwright::nn {
namespace {

bool TakesFused(const torch::nn::Module& module, UpdateKernels kernels) {
  if (kernels != UpdateKernels::kAutomatic) return kernels == UpdateKernels::kFused;
  const std::vector<torch::Tensor> parameters = module.parameters();
  return HasFusedUpdate() && !parameters.empty() && parameters.front().is_cuda();
}

}  // namespace

bool TrainerOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (steps < 1 || save_every < 1) return fail("steps and save_every must be at least 1");
  if (!(learning_rate > 0.0) || !(largest_norm > 0.0)) {
    return fail("the learning rate and the gradient's largest norm must be positive");
  }
  if (!(weight_decay >= 0.0) || !(warm_share >= 0.0 && warm_share < 1.0)) {
    return fail("the weight decay must not be negative, the warm-up shorter than the training");
  }
  if (!(ema_decay >= 0.0 && ema_decay < 1.0)) return fail("the average's decay must lie in [0, 1)");
  return true;
}

Trainer::Trainer(torch::nn::Module* module, const TrainerOptions& options,
                 const std::filesystem::path& state)
    : module_(module), options_(options), state_(state) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "training");
  update_ = TakesFused(*module, options.kernels) ? MakeFusedUpdate(module, options)
                                                 : MakeSeparateUpdate(module, options);
  if (options.resume && std::filesystem::exists(state)) LoadState();
}

double Trainer::LearningRate(int step) const {
  const double done = static_cast<double>(step) / options_.steps;
  const double warm =
      std::min(1.0, (step + 1.0) / std::max(1.0, options_.warm_share * options_.steps));
  return options_.learning_rate * warm * (0.525 + 0.475 * std::cos(M_PI * std::min(1.0, done)));
}

void Trainer::Step(int step, const torch::Tensor& loss) {
  SetStep(step);
  Update(loss);
}

void Trainer::SetStep(int step) {
  update_->SetRate(LearningRate(step));
}

void Trainer::Update(const torch::Tensor& loss) {
  if (!update_->ChecksLoss()) {
    if (!std::isfinite(loss.item<double>())) {
      ++skipped_;
      return;
    }
    skipped_ = 0;
  }
  update_->ClearGradients();
  loss.backward();
  update_->Apply(loss);
}

int Trainer::SkippedInARow() const {
  return skipped_ + update_->SkippedInARow();
}

double Trainer::Step(int step, int shares, const std::function<torch::Tensor(int)>& term) {
  if (shares < 1) throw core::Error("a loss needs at least one share", std::to_string(shares));
  if (shares == 1 && update_->ChecksLoss()) {
    const torch::Tensor loss = term(0);
    Step(step, loss);
    return loss.item<double>();  // after all kernels were launched
  }
  const std::vector<torch::Tensor> parameters = module_->parameters();
  std::vector<double> losses(static_cast<size_t>(shares));
  std::vector<torch::autograd::variable_list> gradients(losses.size());
  ForEachShare(shares, [&](int i) {
    const torch::Tensor loss = term(i);
    const size_t at = static_cast<size_t>(i);
    losses[at] = loss.item<double>();
    gradients[at] = torch::autograd::grad({loss}, parameters, {}, {}, false, /*allow_unused=*/true);
  });
  const double sum = std::accumulate(losses.begin(), losses.end(), 0.0);
  skipped_ = std::isfinite(sum) ? 0 : skipped_ + 1;
  if (skipped_ > 0) return sum;
  const SingleThreadedLoops alone;
  for (size_t p = 0; p < parameters.size(); ++p) {
    torch::Tensor whole;
    for (const torch::autograd::variable_list& share : gradients) {
      if (!share[p].defined()) continue;
      whole = whole.defined() ? whole + share[p] : share[p].clone();
    }
    parameters[p].mutable_grad() = whole;
  }
  SetStep(step);
  update_->Apply({});
  return sum;
}

bool Trainer::SaveDue(int step) const {
  return (step + 1) % options_.save_every == 0 || step + 1 == options_.steps;
}

void Trainer::SaveState(int step) const {
  NamedTensors tensors;
  tensors["step"] = torch::tensor(step);
  CollectTensors(*module_, "module.", &tensors);
  update_->Collect(&tensors);
  WriteTensors(tensors, state_);
}

void Trainer::LoadState() {
  const NamedTensors tensors = ReadTensors(state_);
  if (!tensors.contains("step") || !RestoreTensors(tensors, "module.", module_).empty() ||
      !update_->Load(tensors)) {
    throw core::Error("is not a training state of this network", state_.string(),
                      "remove it, or train without --resume");
  }
  first_ = tensors.at("step").item<int>();
}

void Trainer::Finish() const {
  std::error_code missing;
  std::filesystem::remove(state_, missing);
}

}  // namespace simwright::nn
