#include "core/progress.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "core/error.h"

namespace simwright::core {
namespace {

volatile std::sig_atomic_t cancel_requested = 0;

void OnInterrupt(int signal_number) {
  cancel_requested = 1;
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

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

void CheckCancelled() {
  if (CancelRequested()) throw Cancelled();
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
  name_ = name;
  total_ = total;
  done_ = 0;
  last_drawn_ms_ = 0;
  start_ = std::chrono::steady_clock::now();
  if (style_ == Style::kTerminal) Draw(0);
}

void Progress::Advance() {
  CheckCancelled();
  const int done = ++done_;
  if (style_ != Style::kTerminal) return;
  const long now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                          std::chrono::steady_clock::now() - start_)
                          .count();
  long last = last_drawn_ms_.load();
  if (now_ms - last >= 100 && last_drawn_ms_.compare_exchange_strong(last, now_ms)) Draw(done);
}

void Progress::Draw(int done) {
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (total_ > 0 && done > 0) {
    const double left = seconds / done * (total_ - done);
    std::fprintf(stderr, "\r\033[K%s  %d/%d  %.0f s left", name_.c_str(), done, total_, left);
  } else {
    std::fprintf(stderr, "\r\033[K%s ...", name_.c_str());
  }
  std::fflush(stderr);
}

void Progress::Finish() {
  if (name_.empty()) return;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (style_ == Style::kTerminal) std::fprintf(stderr, "\r\033[K");
  if (style_ != Style::kSilent) std::fprintf(stderr, "%s: %.1f s\n", name_.c_str(), seconds);
  name_.clear();
}

}  // namespace simwright::core
