// Memory that is freed below a block in use goes back to the system.
#include "core/free_memory.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace simwright::core {
namespace {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SIMWRIGHT_SANITIZED
#endif
#endif
#if defined(SIMWRIGHT_SANITIZED) || defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
constexpr bool kGlibcAllocates = false;
#else
constexpr bool kGlibcAllocates = true;
#endif

// Returns the resident memory of this process, MiB.
double ResidentMiB() {
  std::ifstream file("/proc/self/statm");
  long total = 0, resident = 0;
  file >> total >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

TEST(ReturnFreeMemory, GivesBackWhatLiesBelowABlockInUse) {
  if (!kGlibcAllocates) GTEST_SKIP() << "another allocator";
  constexpr int kBlocks = 4096;
  std::vector<std::unique_ptr<std::string>> blocks;
  for (int i = 0; i < kBlocks; ++i) {
    blocks.push_back(std::make_unique<std::string>(static_cast<size_t>(32 * 1024), 'x'));
  }
  const auto last = std::make_unique<std::string>(static_cast<size_t>(32 * 1024), 'x');
  const double full = ResidentMiB();
  blocks.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // at most once a second
  ReturnFreeMemory();
  EXPECT_LT(ResidentMiB(), full - 100.0) << "of the 128 MiB that were freed";
  EXPECT_EQ(last->front(), 'x');
}

}  // namespace
}  // namespace simwright::core
