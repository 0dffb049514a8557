#include "core/parallel.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/ranks.h"

namespace simwright::core {
namespace {

std::atomic<int> thread_count{0};
thread_local bool inside_parallel_for = false;

// Returns the number of processors that a process may use; 0 if unknown.
int ProcessorsOf(pid_t process) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  return sched_getaffinity(process, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 0;
}

// Returns the processors available to this process, its share where several ranks are on this
// machine. std::thread::hardware_concurrency also counts those that `taskset` or a container
// withholds, and more threads than processors wait for each other at every loop's end.
int MachineThreads() {
  int here = ProcessorsOf(0);
  if (here == 0) here = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return ThreadsOf(ThisRank(), here, ProcessorsOf(getppid()));
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
