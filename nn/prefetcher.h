#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace simwright::nn {

// A thread that makes the items first .. last - 1 in order, each once the one before was taken. It
// has the constructing thread's gradient mode and number of threads for loops, so that it gives the
// same numbers, and receives no signals.
class PrefetchThread {
 public:
  PrefetchThread(int first, int last, std::function<void(int)> make);
  // Waits for the item that is being made.
  ~PrefetchThread();
  PrefetchThread(const PrefetchThread&) = delete;
  PrefetchThread& operator=(const PrefetchThread&) = delete;

  // Waits for the next item and calls `take`, after which the thread makes another one. Rethrows
  // what making the item threw, in this call and in later ones.
  void Take(const std::function<void()>& take);

 private:
  void Run(int first, int last);

  std::function<void(int)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_made_ = false, stopped_ = false;  // guarded by mutex_, like failure_
  std::exception_ptr failure_;
  std::thread thread_;
};

// Makes the items of a loop, such as the batches of a training: one ahead on a thread of its own
// while the caller works on the last one, or as they are asked for. The items are the same.
template <typename Item>
class Prefetcher {
 public:
  // `make(i)` returns item i; it is called once for each i in [first, last), in order, and must
  // outlive the prefetcher with all that it refers to. `ahead`: on a thread of its own.
  Prefetcher(bool ahead, int first, int last, std::function<Item(int)> make)
      : make_(std::move(make)), next_(first) {
    if (ahead && first < last) {
      thread_.emplace(first, last, [this](int i) { made_ = make_(i); });
    }
  }

  // Returns the next item; call it at most last - first times. Throws what `make` throws.
  Item Next() {
    if (!thread_) return make_(next_++);
    std::optional<Item> item;
    thread_->Take([&] {
      item = std::move(made_);
      made_.reset();
    });
    return std::move(*item);
  }

 private:
  std::function<Item(int)> make_;
  int next_;
  std::optional<Item> made_;
  std::optional<PrefetchThread> thread_;  // destroyed first: it uses the others
};

}  // namespace simwright::nn
