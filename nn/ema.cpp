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

void Ema::Save(torch::serialize::OutputArchive* archive) const {
  archive->write("updates", torch::tensor(static_cast<std::int64_t>(updates_)), true);
  for (size_t i = 0; i < average_.size(); ++i) {
    archive->write(std::to_string(i), average_[i].to(torch::kCPU), true);
  }
}

void Ema::Load(torch::serialize::InputArchive* archive) {
  const torch::NoGradGuard no_grad;
  torch::Tensor updates;
  archive->read("updates", updates, true);
  updates_ = updates.item<long>();
  for (size_t i = 0; i < average_.size(); ++i) {
    torch::Tensor stored;
    archive->read(std::to_string(i), stored, true);
    average_[i].copy_(stored);
  }
}

}  // namespace simwright::nn
