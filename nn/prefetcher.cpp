#include "nn/prefetcher.h"

#include <pthread.h>

#include <csignal>

#include <ATen/ThreadLocalState.h>

#include "nn/compute.h"

namespace simwright::nn {

PrefetchThread::PrefetchThread(int first, int last, std::function<void(int)> make)
    : make_(std::move(make)) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const at::ThreadLocalState state;
  const int loops = at::get_num_threads();
  try {
    thread_ = std::thread([this, first, last, state, loops] {
      const at::ThreadLocalStateGuard as_there(state);
      SetLoopThreads(loops);
      Run(first, last);
    });
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

PrefetchThread::~PrefetchThread() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PrefetchThread::Run(int first, int last) {
  for (int i = first; i < last; ++i) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return stopped_ || !is_made_; });
    if (stopped_) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      make_(i);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    is_made_ = true;
    changed_.notify_all();
    if (failure) return;
  }
}

void PrefetchThread::Take(const std::function<void()>& take) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_made_; });
  if (failure_) std::rethrow_exception(failure_);
  take();
  is_made_ = false;
  changed_.notify_all();
}

}  // namespace simwright::nn
