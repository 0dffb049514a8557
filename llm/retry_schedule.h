#pragma once

#include <optional>
#include <string>

#include "core/random.h"

namespace simwright::llm {

// The client's clock; tests replace it by one that does not wait.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double UnixSeconds() = 0;
  // Returns after `seconds`, or as soon as Cancelled() becomes true.
  virtual void Sleep(double seconds) = 0;
  virtual bool Cancelled() = 0;
};

// Returns the system's clock; Ctrl-C cancels it (core::CancelRequested).
Clock& SystemClock();

// The waits before the second, third ... attempt: exponential backoff, first_wait 2^n, at most
// longest_wait, minus a random share of up to half, so that clients that failed together do not
// return together.
class RetrySchedule {
 public:
  RetrySchedule(double first_wait, double longest_wait, core::Rng rng)
      : next_(first_wait), longest_(longest_wait), rng_(rng) {}
  double NextWait();  // s

 private:
  double next_, longest_;
  core::Rng rng_;
};

// Returns the seconds that a Retry-After header asks for: a number, or an HTTP date counted from
// `now` (s since 1970). Never negative; unset if `header` is neither.
std::optional<double> RetryAfterSeconds(const std::string& header, double now);

}  // namespace simwright::llm
