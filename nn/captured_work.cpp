#include "nn/captured_work.h"

// Defined by nn/CMakeLists.txt where there are the headers of CUDA.
#ifdef SIMWRIGHT_CUDA_GRAPHS
#include <torch/version.h>
#if TORCH_VERSION_MAJOR < 2
#undef SIMWRIGHT_CUDA_GRAPHS
#endif
#endif

#ifdef SIMWRIGHT_CUDA_GRAPHS
#include <ATen/cuda/CUDAGraph.h>
#include <c10/cuda/CUDAGuard.h>
#include <c10/cuda/CUDAStream.h>
#endif

namespace simwright::nn {

#ifdef SIMWRIGHT_CUDA_GRAPHS
namespace {

// Runs in which libraries choose their kernels and make their workspaces, before the capture.
constexpr int kWarmUpRuns = 3;

}  // namespace

struct CapturedWork::Graph {
  at::cuda::CUDAGraph graph;
  // A capture needs a stream other than the default one.
  c10::cuda::CUDAStream stream = c10::cuda::getStreamFromPool();
  int runs = 0;
  bool is_captured = false;

  // Calls `body` on the own stream, after the work of the current one and before its next.
  void OnStream(const std::function<void()>& body) {
    c10::cuda::getCurrentCUDAStream().synchronize();
    {
      const c10::cuda::CUDAStreamGuard on_stream(stream);
      body();
    }
    stream.synchronize();
  }

  // Ends a capture whose work failed: else the stream would go on capturing.
  void EndCapture() noexcept {
    try {
      graph.capture_end();
    } catch (...) {  // the failure of the work is the one to report
    }
  }

  void Capture(const std::function<void()>& work) {
    OnStream([&] {
      // Other threads, such as that of the next batch, may allocate and copy meanwhile.
      graph.capture_begin({0, 0}, cudaStreamCaptureModeThreadLocal);
      try {
        work();
      } catch (...) {
        EndCapture();
        throw;
      }
      graph.capture_end();
    });
    is_captured = true;
  }
};

bool CapturedWork::IsAvailable(const torch::Device& device) {
  return device.is_cuda();
}

CapturedWork::CapturedWork(const torch::Device& device, std::function<void()> work)
    : work_(std::move(work)), graph_(IsAvailable(device) ? std::make_unique<Graph>() : nullptr) {}

void CapturedWork::Run() {
  if (!graph_) return work_();
  if (graph_->runs++ < kWarmUpRuns) return graph_->OnStream(work_);
  if (!graph_->is_captured) graph_->Capture(work_);
  graph_->graph.replay();
}

#else

struct CapturedWork::Graph {};

bool CapturedWork::IsAvailable(const torch::Device&) {
  return false;
}

CapturedWork::CapturedWork(const torch::Device&, std::function<void()> work)
    : work_(std::move(work)) {}

void CapturedWork::Run() {
  work_();
}

#endif

CapturedWork::~CapturedWork() = default;

}  // namespace simwright::nn
