#include "nn/compute.h"

#include <malloc.h>

#include <algorithm>

#include <ATen/ThreadLocalState.h>

#include "core/device_choice.h"
#include "core/error.h"
#include "core/parallel.h"

// Functions of the OpenMP that libtorch uses, and of OpenBLAS if it provides libblas: it has its
// own threads.
extern "C" {
__attribute__((weak)) void omp_set_num_threads(int count);
__attribute__((weak)) void openblas_set_num_threads(int count);
__attribute__((weak)) int openblas_get_num_threads(void);
// Sets the calling thread's own number in the MKL that PyTorch's builds of libtorch contain, and
// returns the number before.
__attribute__((weak)) int MKL_Set_Num_Threads_Local(int count);
}

namespace simwright::nn {

torch::Device BestDevice() {
  const core::DeviceChoice choice = core::ChosenDevice();
  if (choice == core::DeviceChoice::kCpu) return torch::Device(torch::kCPU);
  const bool has_gpu = torch::cuda::is_available();
  if (choice == core::DeviceChoice::kCuda && !has_gpu) {
    throw core::Error("libtorch finds no GPU", "--device cuda",
                      "use --device auto, or build with a libtorch that has CUDA (docs/lift.md)");
  }
  return torch::Device(has_gpu ? torch::kCUDA : torch::kCPU);
}

void SetLoopThreads(int count) {
  // at::set_num_threads would make every new thread create a pool whose threads spin: libtorch
  // repeats the call on a thread's first loop.
  at::get_num_threads();  // sets the thread's default, which the next line replaces
  if (omp_set_num_threads != nullptr) omp_set_num_threads(count);
}

void PrepareForWork() {
  SetLoopThreads(core::ThreadCount());
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(core::ThreadCount());
  // The tensors of a step, some tens of MB, are freed at its end and needed again by the next. By
  // default glibc returns such memory to the system in between.
  constexpr int kKept = 1 << 30, kGrowth = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kGrowth);
}

// libtorch sets a thread's number of workers on first use.
SingleThreadedLoops::SingleThreadedLoops() : before_(at::get_num_threads()) {
  if (omp_set_num_threads != nullptr) omp_set_num_threads(1);
  if (MKL_Set_Num_Threads_Local != nullptr) mkl_before_ = MKL_Set_Num_Threads_Local(1);
}

SingleThreadedLoops::~SingleThreadedLoops() {
  if (omp_set_num_threads != nullptr) omp_set_num_threads(before_);
  if (MKL_Set_Num_Threads_Local != nullptr) MKL_Set_Num_Threads_Local(mkl_before_);
}

SingleThreadedProducts::SingleThreadedProducts() {
  if (openblas_set_num_threads == nullptr || openblas_get_num_threads == nullptr) return;
  before_ = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

SingleThreadedProducts::~SingleThreadedProducts() {
  if (before_ > 1) openblas_set_num_threads(before_);
}

int ShareCount(const torch::Device& device, std::int64_t items) {
  if (!device.is_cpu()) return 1;
  return static_cast<int>(std::clamp<std::int64_t>(items, 1, core::ThreadCount()));
}

void ForEachShare(int count, const std::function<void(int)>& body) {
  if (count == 1) return body(0);
  const at::ThreadLocalState state;
  const SingleThreadedProducts products;
  core::ParallelFor(count, [&](int i) {
    const at::ThreadLocalStateGuard as_here(state);
    const SingleThreadedLoops loops;
    body(i);
  });
}

}  // namespace simwright::nn
