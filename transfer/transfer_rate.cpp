#include "transfer/transfer_rate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace simwright::transfer {
namespace {

constexpr double kLargest = 4.0, kResolution = 1.0 / 16.0;

// Returns true if at least `share` of the worlds succeed. Stops as soon as the answer is known.
bool Holds(const WorldTrial& trial, double scale, int worlds, double share) {
  const int needed = static_cast<int>(std::ceil(share * worlds - 1e-9));
  const int batch = 2 * core::ThreadCount();
  int successes = 0;
  for (int first = 0; first < worlds; first += batch) {
    const int count = std::min(batch, worlds - first);
    std::vector<char> done(static_cast<size_t>(count));
    core::ParallelFor(count, [&](int i) {
      core::CheckCancelled();
      done[static_cast<size_t>(i)] = trial(scale, static_cast<std::uint64_t>(first + i));
    });
    successes += static_cast<int>(std::count(done.begin(), done.end(), 1));
    if (successes >= needed) return true;
    if (successes + worlds - first - count < needed) return false;
  }
  return successes >= needed;
}

}  // namespace

TransferRate RateAt(const WorldTrial& trial, double scale, int worlds, core::Progress* progress) {
  std::vector<char> done(static_cast<size_t>(worlds));
  core::ParallelFor(worlds, [&](int i) {
    core::CheckCancelled();
    done[static_cast<size_t>(i)] = trial(scale, static_cast<std::uint64_t>(i));
    if (progress != nullptr) progress->Advance();
  });
  TransferRate rate;
  rate.worlds = worlds;
  rate.successes = static_cast<int>(std::count(done.begin(), done.end(), 1));
  rate.interval = rl::WilsonInterval(rate.successes, worlds);
  return rate;
}

double LargestScale(const WorldTrial& trial, const TransferRate& at_one, double share,
                    core::Progress* progress) {
  const auto holds = [&](double scale) {
    const bool held = Holds(trial, scale, at_one.worlds, share);
    if (progress != nullptr) progress->Advance();
    return held;
  };
  double low = 0.0, high = 1.0;
  if (at_one.successes >= std::ceil(share * at_one.worlds - 1e-9)) {
    for (low = 1.0, high = 2.0; high <= kLargest && holds(high); high *= 2.0) low = high;
    if (high > kLargest) return kLargest;
  } else if (!holds(0.0)) {
    return -1.0;
  }
  while (high - low > std::max(kResolution, kResolution * low) * (1.0 + 1e-9)) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace simwright::transfer
