#include "llm/retry_schedule.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/progress.h"
#include "llm/http_client.h"

namespace simwright::llm {
namespace {

class RealClock final : public Clock {
 public:
  double UnixSeconds() override {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  }

  void Sleep(double seconds) override {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    constexpr std::chrono::duration<double> kSlice(0.1);  // delay after which Ctrl-C is noticed
    while (!Cancelled()) {
      const std::chrono::duration<double> left = end - std::chrono::steady_clock::now();
      if (left.count() <= 0.0) return;
      std::this_thread::sleep_for(std::min(left, kSlice));
    }
  }

  bool Cancelled() override { return core::CancelRequested(); }
};

}  // namespace

Clock& SystemClock() {
  static RealClock clock;
  return clock;
}

double RetrySchedule::NextWait() {
  const double wait = std::min(next_, longest_);
  next_ = std::min(2.0 * next_, longest_);
  return wait * (1.0 - 0.5 * core::Uniform(rng_));
}

std::optional<double> RetryAfterSeconds(const std::string& header, double now) {
  if (header.empty()) return std::nullopt;
  double seconds = 0.0;
  const char* const last = header.data() + header.size();
  const auto [end, code] = std::from_chars(header.data(), last, seconds);
  if (code == std::errc() && end == last) {
    if (!std::isfinite(seconds)) return std::nullopt;
    return std::max(0.0, seconds);
  }
  const double date = ParseHttpDate(header);
  if (date < 0.0) return std::nullopt;
  return std::max(0.0, date - now);
}

}  // namespace simwright::llm
