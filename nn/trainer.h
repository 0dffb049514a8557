#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "nn/parameter_update.h"
#include "nn/torch.h"
#include "nn/trainer_options.h"

namespace simwright::nn {

// The part of training that is common to all networks: the optimiser and its learning rate, the
// averaged weights, and the state from which a run resumes.
class Trainer {
 public:
  // Trains `module`, which must outlive the trainer. `state` is the path of the training state; an
  // earlier run's is loaded if `options.resume` is set. Throws core::Error for invalid options or
  // another network's state.
  Trainer(torch::nn::Module* module, const TrainerOptions& options,
          const std::filesystem::path& state);

  // Returns the first step: 0, or where the earlier run stopped.
  int first_step() const { return first_; }
  double LearningRate(int step) const;
  // Returns true if Step(step, loss) reads nothing back from a GPU.
  bool IsFused() const { return update_->ChecksLoss(); }
  // Takes one optimiser step along the gradient of `loss`. Skips a loss that is not finite.
  void Step(int step, const torch::Tensor& loss);
  // The two parts of Step(step, loss): SetStep sets the learning rate, Update takes the step.
  void SetStep(int step);
  void Update(const torch::Tensor& loss);
  // Returns the number of losses in a row, up to the last one, that were not finite; waits for a
  // GPU.
  int SkippedInARow() const;
  // Takes one optimiser step for a loss that is the sum of `shares` terms, each computed on its own
  // thread (ForEachShare): term(i) returns a scalar that depends on the module's parameters.
  // Returns the sum. For the same number of shares the result is the same bit for bit. Throws
  // core::Error for fewer than 1 share, and rethrows what a term throws.
  double Step(int step, int shares, const std::function<torch::Tensor(int)>& term);
  // Returns true if the state is due to be saved after `step`.
  bool SaveDue(int step) const;
  void SaveState(int step) const;
  // Copies the averaged weights into `module`.
  void CopyAverageTo(torch::nn::Module* module) const { update_->CopyAverageTo(module); }
  // Ends the training: deletes the state from which it would resume.
  void Finish() const;

 private:
  void LoadState();

  torch::nn::Module* module_;
  TrainerOptions options_;
  std::filesystem::path state_;
  std::unique_ptr<ParameterUpdate> update_;
  int first_ = 0, skipped_ = 0;  // skipped_: losses that were read here
};

}  // namespace simwright::nn
