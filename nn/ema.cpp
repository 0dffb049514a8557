#include "nn/ema.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::nn {

Ema::Ema(const torch::nn::Module& module, double decay) : decay_(decay) {
  if (!(decay >= 0.0 && decay < 1.0)) throw core::Error("the average's decay must lie in [0, 1)");
  for (const torch::Tensor& p : module.parameters()) average_.push_back(p.detach().clone());
}

void Ema::Update(const torch::nn::Module& module) {
  const torch::NoGradGuard no_grad;
  const double n = static_cast<double>(updates_++);
  const double decay = std::min(decay_, (1.0 + n) / (10.0 + n));
  const std::vector<torch::Tensor> now = module.parameters();
  for (size_t i = 0; i < now.size(); ++i) average_[i].lerp_(now[i].detach(), 1.0 - decay);
}

void Ema::CopyTo(torch::nn::Module* module) const {
  const torch::NoGradGuard no_grad;
  const std::vector<torch::Tensor> now = module->parameters();
  for (size_t i = 0; i < now.size(); ++i) now[i].copy_(average_[i]);
}

void Ema::Collect(NamedTensors* tensors) const {
  (*tensors)["average.updates"] = torch::tensor(static_cast<std::int64_t>(updates_));
  for (size_t i = 0; i < average_.size(); ++i) {
    (*tensors)["average." + std::to_string(i)] = average_[i];
  }
}

bool Ema::Load(const NamedTensors& tensors) {
  const torch::NoGradGuard no_grad;
  const auto updates = tensors.find("average.updates");
  if (updates == tensors.end()) return false;
  for (size_t i = 0; i < average_.size(); ++i) {
    const auto found = tensors.find("average." + std::to_string(i));
    if (found == tensors.end() || !found->second.sizes().equals(average_[i].sizes())) return false;
    average_[i].copy_(found->second);
  }
  updates_ = updates->second.item<std::int64_t>();
  return true;
}

}  // namespace simwright::nn
