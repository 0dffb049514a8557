#include "nn/trainer.h"

#include <cmath>
#include <numeric>
#include <sstream>
#include <type_traits>

#include "core/error.h"
#include "nn/compute.h"
#include "nn/tensor_file.h"

namespace simwright::nn {
namespace {

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
  optimizer_ = std::make_unique<torch::optim::AdamW>(
      module->parameters(),
      torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
  average_ = std::make_unique<Ema>(*module, options.ema_decay);
  if (options.resume && std::filesystem::exists(state)) LoadState();
}

double Trainer::LearningRate(int step) const {
  const double done = static_cast<double>(step) / options_.steps;
  const double warm =
      std::min(1.0, (step + 1.0) / std::max(1.0, options_.warm_share * options_.steps));
  return options_.learning_rate * warm * (0.525 + 0.475 * std::cos(M_PI * std::min(1.0, done)));
}

void Trainer::Step(int step, const torch::Tensor& loss) {
  if (!std::isfinite(loss.item<double>())) return;
  optimizer_->zero_grad();
  loss.backward();
  TakeStep(step);
}

double Trainer::Step(int step, int shares, const std::function<torch::Tensor(int)>& term) {
  if (shares < 1) throw core::Error("a loss needs at least one share", std::to_string(shares));
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
  if (!std::isfinite(sum)) return sum;
  const SingleThreadedLoops alone;
  for (size_t p = 0; p < parameters.size(); ++p) {
    torch::Tensor whole;
    for (const torch::autograd::variable_list& share : gradients) {
      if (!share[p].defined()) continue;
      whole = whole.defined() ? whole + share[p] : share[p].clone();
    }
    parameters[p].mutable_grad() = whole;
  }
  TakeStep(step);
  return sum;
}

void Trainer::TakeStep(int step) {
  const SingleThreadedLoops alone;
  for (auto& group : optimizer_->param_groups()) {
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(LearningRate(step));
  }
  torch::nn::utils::clip_grad_norm_(module_->parameters(), options_.largest_norm);
  optimizer_->step();
  average_->Update(*module_);
}

bool Trainer::SaveDue(int step) const {
  return (step + 1) % options_.save_every == 0 || step + 1 == options_.steps;
}

void Trainer::SaveState(int step) const {
  NamedTensors tensors;
  tensors["step"] = torch::tensor(step);
  CollectTensors(*module_, "module.", &tensors);
  average_->Collect(&tensors);
  // AdamW's moments, in the order of the parameters.
  const std::vector<torch::Tensor> parameters = module_->parameters();
  for (size_t i = 0; i < parameters.size(); ++i) {
    const auto found = optimizer_->state().find(StateKey(optimizer_->state(), parameters[i]));
    if (found == optimizer_->state().end()) continue;
    const auto& moments = static_cast<const torch::optim::AdamWParamState&>(*found->second);
    const std::string name = "adam." + std::to_string(i);
    tensors[name + ".step"] = torch::tensor(moments.step());
    tensors[name + ".first"] = moments.exp_avg();
    tensors[name + ".second"] = moments.exp_avg_sq();
  }
  WriteTensors(tensors, state_);
}

void Trainer::LoadState() {
  const NamedTensors tensors = ReadTensors(state_);
  if (!tensors.contains("step") || !RestoreTensors(tensors, "module.", module_).empty() ||
      !average_->Load(tensors)) {
    throw core::Error("is not a training state of this network", state_.string(),
                      "remove it, or train without --resume");
  }
  const std::vector<torch::Tensor> parameters = module_->parameters();
  for (size_t i = 0; i < parameters.size(); ++i) {
    const std::string name = "adam." + std::to_string(i);
    if (!tensors.contains(name + ".step")) continue;
    auto moments = std::make_unique<torch::optim::AdamWParamState>();
    moments->step(tensors.at(name + ".step").item<std::int64_t>());
    moments->exp_avg(tensors.at(name + ".first").to(parameters[i].device()));
    moments->exp_avg_sq(tensors.at(name + ".second").to(parameters[i].device()));
    optimizer_->state()[StateKey(optimizer_->state(), parameters[i])] = std::move(moments);
  }
  first_ = tensors.at("step").item<int>();
}

void Trainer::Finish() const {
  std::error_code missing;
  std::filesystem::remove(state_, missing);
}

}  // namespace simwright::nn
