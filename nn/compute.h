#pragma once

#include <functional>

#include "nn/torch.h"

namespace simwright::nn {

// Returns the device that core::ChosenDevice() stands for. Throws core::Error for kCuda where
// libtorch finds no GPU.
torch::Device BestDevice();

// Gives libtorch core::ThreadCount() threads for the loops of the calling thread (its default is
// one where two hyperthreads share a core) and for products, and keeps memory freed by a step for
// the next one. Call it before heavy work.
void PrepareForWork();

// Gives libtorch `count` threads for the loops of the calling thread.
void SetLoopThreads(int count);

// A scope guard that makes libtorch's loops, and MKL's products if libtorch has MKL, on the
// constructing thread single-threaded: waking another thread takes longer than a loop over some ten
// thousand numbers.
class SingleThreadedLoops {
 public:
  SingleThreadedLoops();
  ~SingleThreadedLoops();
  SingleThreadedLoops(const SingleThreadedLoops&) = delete;
  SingleThreadedLoops& operator=(const SingleThreadedLoops&) = delete;

 private:
  int before_, mkl_before_ = 0;
};

// A scope guard that makes matrix products of all threads single-threaded. OpenBLAS's threads wait
// for the next product with a core each.
class SingleThreadedProducts {
 public:
  SingleThreadedProducts();
  ~SingleThreadedProducts();
  SingleThreadedProducts(const SingleThreadedProducts&) = delete;
  SingleThreadedProducts& operator=(const SingleThreadedProducts&) = delete;

 private:
  int before_ = 0;
};

// Returns the number of shares into which to split `items` of a batch on `device`: one per CPU
// thread and at most one per item; one for a GPU.
int ShareCount(const torch::Device& device, std::int64_t items);

// The items of share `i` of `shares`, split as evenly as possible: [first, first + count).
struct Share {
  std::int64_t first, count;
};
inline Share ShareOf(std::int64_t items, int shares, int i) {
  const std::int64_t first = items * i / shares;
  return {first, items * (i + 1) / shares - first};
}

// Calls body(i) once for each i in [0, count), each on a thread of its own whose loops and products
// are single-threaded, and waits. Gradient mode is inherited from the caller. The layers of a small
// network are too short to split, so one thread per share is faster than several threads per layer
// (bench_training_speed). Rethrows what a body threw.
void ForEachShare(int count, const std::function<void(int)>& body);

}  // namespace simwright::nn
