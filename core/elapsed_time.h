#pragma once

#include <chrono>

namespace simwright::core {

// A time of the clock that never jumps.
using SteadyTime = std::chrono::steady_clock::time_point;

inline SteadyTime Now() {
  return std::chrono::steady_clock::now();
}

// Returns the seconds from `start` until now.
inline double SecondsSince(SteadyTime start) {
  return std::chrono::duration<double>(Now() - start).count();
}

// Adds the time of its life to a sum of seconds.
class ScopedTimer {
 public:
  explicit ScopedTimer(double* seconds) : seconds_(seconds), start_(Now()) {}
  ~ScopedTimer() { *seconds_ += SecondsSince(start_); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double* seconds_;
  SteadyTime start_;
};

}  // namespace simwright::core
