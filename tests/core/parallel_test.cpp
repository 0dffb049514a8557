// By default as many threads as processors that the process may use.
#include "core/parallel.h"

#include <gtest/gtest.h>
#include <sched.h>

namespace simwright::core {
namespace {

TEST(ThreadCount, CountsTheProcessorsThatTheProcessMayRunOn) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  SetThreadCount(0);
  EXPECT_EQ(ThreadCount(), CPU_COUNT(&before));
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(ThreadCount(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(ThreadCount(), CPU_COUNT(&before));
}

}  // namespace
}  // namespace simwright::core
