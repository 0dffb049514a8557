// Memory freed by a training step is reused by the next one.
#include "nn/compute.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <thread>

#include "core/device_choice.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::nn {
namespace {

// Returns the number of pages that the system has handed out.
long PageFaults() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

// The tensors of a step: freed together at its end, 24 MB, each larger than glibc's mmap threshold.
void Step() {
  torch::NoGradGuard no_gradient;
  std::vector<torch::Tensor> kept;
  for (int i = 0; i < 6; ++i) kept.push_back(torch::full({1 << 20}, i));
}

TEST(PrepareForWork, KeepsTheMemoryThatAStepFrees) {
#if defined(__SANITIZE_ADDRESS__) || defined(SIMWRIGHT_SANITIZED)
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#endif
  PrepareForWork();
  for (int i = 0; i < 10; ++i) Step();
  const long before = PageFaults();
  for (int i = 0; i < 10; ++i) Step();
  // 10 x 24 MB are 61440 pages of 4 kB, and glibc's default takes twice as many. The system may
  // reclaim a page that has not been used for a while.
  EXPECT_LT(PageFaults() - before, 30000);
}

TEST(ForEachShare, GivesEachShareAThreadOfItsOwn) {
  PrepareForWork();
  const int before = at::get_num_threads();
  const torch::NoGradGuard no_gradient;
  std::vector<int> threads(4, 0), recorded(4, 1);
  ForEachShare(4, [&](int i) {
    const size_t at = static_cast<size_t>(i);
    threads[at] = at::get_num_threads();
    recorded[at] = torch::GradMode::is_enabled();
  });
  EXPECT_EQ(threads, std::vector<int>(4, 1));
  EXPECT_EQ(recorded, std::vector<int>(4, 0));
  EXPECT_EQ(at::get_num_threads(), before);
  EXPECT_THROW(ForEachShare(3,
                            [](int i) {
                              if (i == 1) throw std::runtime_error("share");
                            }),
               std::runtime_error);
  EXPECT_EQ(at::get_num_threads(), before);
}

TEST(ForEachShare, LeavesNoThreadsThatSpin) {
#if defined(__SANITIZE_ADDRESS__) || defined(SIMWRIGHT_SANITIZED)
  GTEST_SKIP() << "the sanitizer slows down each call";
#endif
  const int before = core::ThreadCount();
  core::SetThreadCount(2);
  PrepareForWork();
  const torch::NoGradGuard no_gradient;
  const std::clock_t start = std::clock();
  for (int i = 0; i < 200; ++i) {
    ForEachShare(2, [](int) {
      EXPECT_EQ(torch::ones({64}).sum().item<float>(), 64.0f);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    });
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  core::SetThreadCount(before);
  // A thread of libtorch's pool that spins meanwhile takes 0.4 s.
  EXPECT_LT(seconds, 0.1);
}

TEST(BestDevice, IsThatOfTheChoice) {
  core::ChooseDevice(core::DeviceChoice::kCpu);
  EXPECT_TRUE(BestDevice().is_cpu());
  core::ChooseDevice(core::DeviceChoice::kCuda);
  if (torch::cuda::is_available()) {
    EXPECT_TRUE(BestDevice().is_cuda());
  } else {
    EXPECT_THROW(BestDevice(), core::Error);
  }
  core::ChooseDevice(core::DeviceChoice::kAuto);
  EXPECT_EQ(BestDevice().is_cuda(), torch::cuda::is_available());
}

TEST(ShareCount, IsOneAThreadAndAtMostOneAnItem) {
  core::SetThreadCount(3);
  EXPECT_EQ(ShareCount(torch::kCPU, 32), 3);
  EXPECT_EQ(ShareCount(torch::kCPU, 2), 2);
  EXPECT_EQ(ShareCount(torch::kCPU, 0), 1);
  EXPECT_EQ(ShareCount(torch::kCUDA, 32), 1);
  core::SetThreadCount(0);
}

}  // namespace
}  // namespace simwright::nn
