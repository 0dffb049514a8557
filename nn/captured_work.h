#pragma once

#include <functional>
#include <memory>

#include "nn/torch.h"

namespace simwright::nn {

// Work on tensors that is the same every time, such as the update of a training with batches of one
// shape. On a GPU its kernels are captured as a CUDA graph after a few runs, and launched together
// from then on: a small network's hundreds of launches take longer than their kernels.
class CapturedWork {
 public:
  // Returns true if work on `device` can be captured: on a GPU, with libtorch 2.x, built
  // where there are the headers of CUDA.
  static bool IsAvailable(const torch::Device& device);

  // `work` must read and write the same tensors in every run, whose values may change, read nothing
  // back from the GPU and draw no random numbers. Where IsAvailable(device) is false, it runs
  // every time.
  CapturedWork(const torch::Device& device, std::function<void()> work);
  ~CapturedWork();
  CapturedWork(const CapturedWork&) = delete;
  CapturedWork& operator=(const CapturedWork&) = delete;

  // Runs the work on the current stream. Rethrows what it throws.
  void Run();

 private:
  struct Graph;

  std::function<void()> work_;
  std::unique_ptr<Graph> graph_;  // null: the work cannot be captured
};

}  // namespace simwright::nn
