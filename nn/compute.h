#pragma once

#include <functional>

#include "nn/torch.h"

namespace simwright::nn {

// CUDA where libtorch finds it, else the CPU.
torch::Device BestDevice();

// Gives libtorch core::ThreadCount() threads (it starts with one where two hyperthreads are one
// core), and keeps for it the memory that a step frees. Call before heavy work.
void PrepareForWork();

// While it lives, loops of the thread that made it are done by that thread alone: waking another
// one takes longer than a loop over some ten thousand numbers.
class LoopsAlone {
 public:
  LoopsAlone();
  ~LoopsAlone();
  LoopsAlone(const LoopsAlone&) = delete;
  LoopsAlone& operator=(const LoopsAlone&) = delete;

 private:
  int before_;
};

// Into how many shares to split `items` of a batch that is on `device`: one a thread of the CPU's,
// at most one an item; a GPU takes all at once.
int ShareCount(const torch::Device& device, std::int64_t items);

// The items of share `i` of `shares`, as even as they can be: [first, first + count).
struct Share {
  std::int64_t first, count;
};
inline Share ShareOf(std::int64_t items, int shares, int i) {
  const std::int64_t first = items * i / shares;
  return {first, items * (i + 1) / shares - first};
}

// Calls body(i) once for each i in [0, count), each on a thread of its own with no other threads in
// its loops and products, and waits; whether gradients are recorded is as it is here. Loops over
// the layers of a small network are too short to be split: two threads in each made an update of 32
// scenes 1.1 times as fast as one, a thread for each half of the batch 1.5 times
// (bench_training_speed). Throws what a body threw.
void ForEachShare(int count, const std::function<void(int)>& body);

}  // namespace simwright::nn
