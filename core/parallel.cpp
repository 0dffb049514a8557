#include "core/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace simwright::core {
namespace {

std::atomic<int> thread_count{0};
thread_local bool inside_parallel_for = false;

// Returns the processors available to this process. std::thread::hardware_concurrency also counts
// those that `taskset` or a container withholds, and more threads than processors wait for each
// other at every loop's end.
int MachineThreads() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(1, CPU_COUNT(&allowed));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

int ThreadCount() {
  const int count = thread_count.load();
  return count > 0 ? count : MachineThreads();
}

void SetThreadCount(int count) {
  thread_count = std::max(0, count);
}

void ParallelFor(int count, const std::function<void(int)>& body) {
  const int workers = inside_parallel_for ? 1 : std::min(ThreadCount(), count);
  if (workers <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    inside_parallel_for = true;
    for (int i = next++; i < count; i = next++) {
      try {
        body(i);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
    inside_parallel_for = false;
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 1; t < workers; ++t) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace simwright::core
