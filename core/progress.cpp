#include "core/progress.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <thread>

#include "core/error.h"

namespace simwright::core {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTerminalInterval = 1.0;    // s between redraws while no step completes
constexpr double kShortestInterval = 0.1;    // s between redraws of completed steps
constexpr double kMinutesThreshold = 120.0;  // s

volatile std::sig_atomic_t cancel_requested = 0;

void OnInterrupt(int signal_number) {
  cancel_requested = 1;
  std::signal(signal_number, SIG_DFL);
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string Duration(double seconds) {
  char text[32];
  if (seconds >= kMinutesThreshold) {
    std::snprintf(text, sizeof(text), "%.0f min", seconds / 60.0);
  } else {
    std::snprintf(text, sizeof(text), "%.0f s", seconds);
  }
  return text;
}

}  // namespace

std::string ProgressLine(const ProgressState& state) {
  std::string line = state.name + ": ";
  if (state.total > 0) {
    line += std::to_string(state.done) + "/" + std::to_string(state.total) + ", ";
  }
  if (!state.detail.empty()) line += state.detail + ", ";
  std::optional<double> left;
  if (state.total > 0 && state.done > 0) {
    left = state.elapsed / state.done * std::max(0, state.total - state.done);
  }
  if (!state.most_left) {
    return line + (left ? Duration(*left) + " left" : Duration(state.elapsed) + " so far");
  }
  const double most = std::max(0.0, *state.most_left);
  if (!left) return line + "at most " + Duration(most) + " left";
  return line + Duration(std::min(*left, most)) + " left";
}

// The current stage, and the thread that redraws it between steps. All members are guarded by
// `mutex`.
struct Progress::Shared {
  Shared(Style drawn_as, double interval, ProgressListener told, const std::atomic<int>& steps)
      : style(drawn_as), seconds(interval), listener(std::move(told)), done(steps) {
    // Block signals in the redraw thread: they must wake the working thread where it waits.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    redraw_thread = std::thread([this] { RedrawBetweenSteps(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Shared() {
    {
      const std::lock_guard lock(mutex);
      stopped = true;
    }
    changed.notify_all();
    redraw_thread.join();
  }

  void RedrawBetweenSteps() {
    std::unique_lock lock(mutex);
    while (!stopped) {
      const long stage = stages;
      const bool other = changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                          [&] { return stopped || stages != stage; });
      if (!other && !state.name.empty()) Draw();
    }
  }
  void Draw() {
    ProgressState now = state;
    now.done = done;
    now.elapsed = SecondsSince(start);
    if (now.most_left) *now.most_left -= SecondsSince(said);
    drawn = Clock::now();
    if (style == Style::kListener) {
      listener(now);
      return;
    }
    const std::string line = ProgressLine(now);
    if (style == Style::kTerminal) {
      std::fprintf(stderr, "\r\033[K%s", line.c_str());
    } else {
      std::fprintf(stderr, "%s\n", line.c_str());
    }
    std::fflush(stderr);
  }

  const Style style;
  const double seconds;
  const ProgressListener listener;
  const std::atomic<int>& done;
  std::mutex mutex;
  std::condition_variable changed;
  bool stopped = false;
  long stages = 0;      // stages started
  ProgressState state;  // its name is empty between stages
  Clock::time_point start{}, said{}, drawn{};
  std::thread redraw_thread;
};

void InstallCancelHandler() {
  std::signal(SIGINT, OnInterrupt);
  std::signal(SIGTERM, OnInterrupt);
}

void RequestCancel() {
  cancel_requested = 1;
}

bool CancelRequested() {
  return cancel_requested != 0;
}

void ClearCancelRequest() {
  cancel_requested = 0;
}

void CheckCancelled() {
  if (CancelRequested()) throw Cancelled();
}

Progress::Progress(Style style, double plain_interval) : style_(style) {
  if (style_ == Style::kSilent) return;
  const double interval = style_ == Style::kTerminal ? kTerminalInterval : plain_interval;
  shared_ = std::make_unique<Shared>(style_, interval, ProgressListener(), done_);
}

Progress::Progress(ProgressListener listener, double interval) : style_(Style::kListener) {
  shared_ = std::make_unique<Shared>(style_, interval, std::move(listener), done_);
}

Progress::~Progress() {
  Finish();
}

Progress::Style Progress::StyleForStderr() {
  return isatty(STDERR_FILENO) ? Style::kTerminal : Style::kPlain;
}

void Progress::Stage(const std::string& name, int total) {
  CheckCancelled();
  Finish();
  done_ = 0;
  if (!shared_) return;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->state = {};
    shared_->state.name = name;
    shared_->state.total = total;
    shared_->start = shared_->said = Clock::now();
    ++shared_->stages;
    if (style_ != Style::kPlain) shared_->Draw();
  }
  shared_->changed.notify_all();
}

void Progress::Say(const std::string& detail, std::optional<double> most_left) {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  shared_->state.detail = detail;
  shared_->state.most_left = most_left;
  shared_->said = Clock::now();
}

void Progress::Advance() {
  CheckCancelled();
  ++done_;
  if (style_ != Style::kTerminal && style_ != Style::kListener) return;
  const std::lock_guard lock(shared_->mutex);
  if (SecondsSince(shared_->drawn) >= kShortestInterval) shared_->Draw();
}

void Progress::Finish() {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  if (shared_->state.name.empty()) return;
  if (style_ == Style::kListener) {
    shared_->Draw();  // the last count
    shared_->state = {};
    shared_->listener(shared_->state);
    return;
  }
  if (style_ == Style::kTerminal) std::fprintf(stderr, "\r\033[K");
  std::fprintf(stderr, "%s: %.1f s\n", shared_->state.name.c_str(), SecondsSince(shared_->start));
  shared_->state = {};
}

}  // namespace simwright::core
