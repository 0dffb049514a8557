#include "nn/compute.h"

#include <malloc.h>

#include <algorithm>

#include <ATen/ThreadLocalState.h>

#include "core/parallel.h"

// Of the OpenMP that libtorch came with, and of OpenBLAS, where that is what libblas stands for: its
// threads are others.
extern "C" {
__attribute__((weak)) void omp_set_num_threads(int count);
__attribute__((weak)) void openblas_set_num_threads(int count);
__attribute__((weak)) int openblas_get_num_threads(void);
}

namespace simwright::nn {
namespace {

// While it lives, products of any thread are done by the thread alone.
class ProductsAlone {
 public:
  ProductsAlone() {
    if (openblas_set_num_threads == nullptr || openblas_get_num_threads == nullptr) return;
    before_ = openblas_get_num_threads();
    openblas_set_num_threads(1);
  }
  ~ProductsAlone() {
    if (before_ > 1) openblas_set_num_threads(before_);
  }
  ProductsAlone(const ProductsAlone&) = delete;
  ProductsAlone& operator=(const ProductsAlone&) = delete;

 private:
  int before_ = 0;
};

}  // namespace

torch::Device BestDevice() {
  return torch::Device(torch::cuda::is_available() ? torch::kCUDA : torch::kCPU);
}

void PrepareForWork() {
  at::set_num_threads(core::ThreadCount());
  // A step's tensors, some tens of MB, are freed at its end and wanted again by the next. Until
  // something as large has been freed, glibc hands them back to the system in between: an update
  // of the scenes' model took 205 ms of a core, and takes 175.
  constexpr int kKept = 1 << 30, kGrowth = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kGrowth);
}

// libtorch sets a thread's number when that is first asked for.
LoopsAlone::LoopsAlone() : before_(at::get_num_threads()) {
  if (omp_set_num_threads != nullptr) omp_set_num_threads(1);
}

LoopsAlone::~LoopsAlone() {
  if (omp_set_num_threads != nullptr) omp_set_num_threads(before_);
}

int ShareCount(const torch::Device& device, std::int64_t items) {
  if (!device.is_cpu()) return 1;
  return static_cast<int>(std::clamp<std::int64_t>(items, 1, core::ThreadCount()));
}

void ForEachShare(int count, const std::function<void(int)>& body) {
  if (count == 1) return body(0);
  const at::ThreadLocalState state;
  const ProductsAlone products;
  core::ParallelFor(count, [&](int i) {
    const at::ThreadLocalStateGuard as_here(state);
    const LoopsAlone loops;
    body(i);
  });
}

}  // namespace simwright::nn
