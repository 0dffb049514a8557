#pragma once

#include <optional>
#include <string>

#include "core/random.h"

namespace simwright::llm {

// Time as the client meets it; tests put one in its place that takes none.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double UnixSeconds() = 0;
  // Returns after `seconds`, or earlier where Cancelled() has become true.
  virtual void Sleep(double seconds) = 0;
  virtual bool Cancelled() = 0;
};

// The system's clock; cancelled by Ctrl-C (core::CancelRequested).
Clock& SystemClock();

// Waits before the second, third ... attempt: first_wait 2^n, at most longest_wait, of which a
// random half at most is left out, so that clients that failed together do not return together.
class RetrySchedule {
 public:
  RetrySchedule(double first_wait, double longest_wait, core::Rng rng)
      : next_(first_wait), longest_(longest_wait), rng_(rng) {}
  double NextWait();  // s

 private:
  double next_, longest_;
  core::Rng rng_;
};

// Seconds that a Retry-After header asks for: a number, or an HTTP date counted from `now` (s
// since 1970). Never negative; unset where `header` is neither.
std::optional<double> RetryAfterSeconds(const std::string& header, double now);

}  // namespace simwright::llm
