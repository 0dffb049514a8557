// Memory that a step of a training frees is there for the next one.
#include "nn/compute.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace simwright::nn {
namespace {

// Pages that the system had to hand out so far.
long PageFaults() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

// A step's tensors: freed together at its end, 24 MB, none smaller than what glibc maps alone.
void Step() {
  torch::NoGradGuard no_gradient;
  std::vector<torch::Tensor> kept;
  for (int i = 0; i < 6; ++i) kept.push_back(torch::full({1 << 20}, i));
}

TEST(PrepareForWork, KeepsTheMemoryThatAStepFrees) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#endif
  PrepareForWork();
  for (int i = 0; i < 3; ++i) Step();
  const long before = PageFaults();
  for (int i = 0; i < 10; ++i) Step();
  // 10 x 24 MB are 61440 pages of 4 kB.
  EXPECT_LT(PageFaults() - before, 600);
}

}  // namespace
}  // namespace simwright::nn
