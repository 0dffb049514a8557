#include "nn/ema.h"

#include <algorithm>

#include "core/error.h"

namespace simwright::nn {

Ema::Ema(const torch::nn::Module& module, double decay) : decay_(decay) {
  if (!(decay >= 0.0 && decay < 1.0)) throw core::Error("an average's decay lies in [0, 1)");
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

}  // namespace simwright::nn
