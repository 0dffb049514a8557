#pragma once

#include <memory>

#include "nn/tensor_file.h"
#include "nn/torch.h"
#include "nn/trainer_options.h"

namespace simwright::nn {

// The update of a module's parameters along their gradients: clipping, AdamW, and the exponential
// moving average. Its saved state has the same names and shapes in both implementations.
class ParameterUpdate {
 public:
  virtual ~ParameterUpdate() = default;

  // Returns true if Apply leaves a loss that is not finite, and counts it, without the caller's
  // reading it, which would wait for a GPU.
  virtual bool ChecksLoss() const = 0;
  virtual void ClearGradients() = 0;
  virtual void SetRate(double rate) = 0;
  // Takes one step along the gradients. `loss`: read only if ChecksLoss(); undefined: it is finite.
  virtual void Apply(const torch::Tensor& loss) = 0;
  // Returns the number of steps left out since the last one that was taken; waits for a GPU.
  virtual int SkippedInARow() const = 0;

  // Copies the average into a module of the same parameters.
  virtual void CopyAverageTo(torch::nn::Module* module) const = 0;
  // Save and restore the moments and the average as tensors. Load returns false if they belong to
  // another module.
  virtual void Collect(NamedTensors* tensors) const = 0;
  virtual bool Load(const NamedTensors& tensors) = 0;
};

// Returns an update of the parameters of `module`, which must outlive it. The fused one has
// libtorch's kernels over all parameters at a time, some ten launches in place of hundreds, and
// reads nothing back from a GPU. It throws core::Error for a libtorch before 2.4.
std::unique_ptr<ParameterUpdate> MakeSeparateUpdate(torch::nn::Module* module,
                                                    const TrainerOptions& options);
std::unique_ptr<ParameterUpdate> MakeFusedUpdate(torch::nn::Module* module,
                                                 const TrainerOptions& options);
bool HasFusedUpdate();

}  // namespace simwright::nn
