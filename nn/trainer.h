#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "nn/ema.h"
#include "nn/torch.h"
#include "nn/trainer_options.h"

namespace simwright::nn {

// The part of a training that is the same for every network: the optimiser and its rate, the
// averaged weights, what is written down to go on from.
class Trainer {
 public:
  // Trains `module`, which must outlive the trainer. `state`: where the training's state is kept;
  // a file of an earlier run is read where `options.resume` is set. Throws core::Error for options
  // that are not valid, or a state of another network.
  Trainer(torch::nn::Module* module, const TrainerOptions& options,
          const std::filesystem::path& state);

  // The step to begin with: 0, or where the earlier run stopped.
  int first_step() const { return first_; }
  double LearningRate(int step) const;
  // One descent along the gradient of `loss`. A loss that is not finite is left out.
  void Descend(int step, const torch::Tensor& loss);
  // The same for a loss that is the sum of `shares` terms, each worked out on a thread of its own
  // (ForEachShare): term(i) gives a scalar over the module's parameters. Returns the sum; the same
  // for the same shares, bit for bit. Throws core::Error for fewer than 1, and what a term throws.
  double Descend(int step, int shares, const std::function<torch::Tensor(int)>& term);
  // Whether the state is due after `step`.
  bool SaveDue(int step) const;
  void SaveState(int step) const;
  // The averaged weights, written into `module`.
  void CopyAverageTo(torch::nn::Module* module) const { average_->CopyTo(module); }
  // The training is done: nothing to go on from is kept.
  void Finish() const;

 private:
  void LoadState();
  void TakeStep(int step);  // along the parameters' gradients

  torch::nn::Module* module_;
  TrainerOptions options_;
  std::filesystem::path state_;
  std::unique_ptr<torch::optim::AdamW> optimizer_;
  std::unique_ptr<Ema> average_;
  int first_ = 0;
};

}  // namespace simwright::nn
