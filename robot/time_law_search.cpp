#include "robot/time_law_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace simwright::robot {
namespace {

constexpr double kCoarsestSpacing = 0.24;  // s between the coarsest knots of the slowness
constexpr int kFirstLevel = 3;             // where the search starts, unless jerk bounds the motion
// A law that takes longer than this times the optimum without jerk is bounded by jerk.
constexpr double kBoundedByJerk = 1.1;
constexpr double kAnyDuration = 1e12;
constexpr int kRaisingRounds = 400;
constexpr double kLargestRaise = 1.5;  // in one iteration
constexpr double kTinyRaise = 1e-9;    // beyond rounding
constexpr double kMostSlowness = 1e4;
constexpr std::array<std::size_t, 6> kCounts = {32, 16, 8, 4, 2, 1};  // coefficients of a stretch
constexpr std::array<double, 4> kLowered = {0.7, 0.85, 0.93, 0.98};
// Coefficient k shapes the intervals k - kReach to k.
constexpr std::size_t kReach = TimeLaw::kSupport - 1;
constexpr int kTriesAStretch = 8;
constexpr Eigen::Index kGridSteps = 16;  // grid steps between the finest knots
// Part of the unused share that may be used between the points that the search looks at.
constexpr double kSlack = 0.75;
constexpr double kPeakMargin = 0.999;     // of the share that a peak needs
constexpr Eigen::Index kFirstStride = 8;  // of the law that the search starts from, and the largest

// Returns every `stride`-th point of a path.
PathDerivatives Thinned(const PathDerivatives& path, Eigen::Index stride) {
  const Eigen::Index count = (path.first.cols() - 1) / stride + 1;
  const auto points = Eigen::seqN(0, count, stride);
  return {path.step * static_cast<double>(stride), path.first(Eigen::all, points),
          path.second(Eigen::all, points), path.third(Eigen::all, points)};
}

std::vector<JointLimits> Shared(std::vector<JointLimits> limits, double share) {
  for (JointLimits& limit : limits) {
    limit.velocity *= share;
    limit.acceleration *= share;
    limit.jerk *= share;
  }
  return limits;
}

// Returns the weight of coefficient `i` of `count` in a move: a bump, without abrupt ends, that
// asks for little jerk.
double Taper(std::size_t i, std::size_t count) {
  if (count < 3) return 1.0;
  const double place = (static_cast<double>(i) + 1.0) / (static_cast<double>(count) + 1.0);
  return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * place);
}

}  // namespace

Eigen::Index TimeLawGrid(double length) {
  const auto knots =
      static_cast<Eigen::Index>(std::max(1.0, std::round(length / kCoarsestSpacing)));
  return knots * kGridSteps * (1 << (kTimeLawLevels - 1));
}

TimeLawSearch::TimeLawSearch(const PathDerivatives& path, double length,
                             const std::vector<JointLimits>& limits, std::vector<double> fastest)
    : path_(path),
      limits_(limits),
      path_limits_(path, limits),
      fastest_(std::move(fastest)),
      law_(length, kCoarsestSpacing) {}

bool TimeLawSearch::Find(double share, int coarser) {
  share_ = share;
  const int last = std::max(kFirstLevel, kTimeLawLevels - 1 - coarser);
  if (!SearchAll(last, kAnyDuration)) return false;
  const double recorded = law_.length();
  const bool faster = *std::max_element(fastest_.begin(), fastest_.end()) > 1.0;
  if (!faster || TimeTable(law_).duration() <= recorded) return true;
  // A motion that limits make slower than its recording: the law that is not faster anywhere
  // may be the better optimum.
  const TimeLaw law = law_;
  std::vector<double> fastest = fastest_;
  for (double& pace : fastest_) pace = std::min(pace, 1.0);
  const bool found = SearchAll(last, first_seconds_);
  fastest_.swap(fastest);
  if (!found || TimeTable(law_).duration() > TimeTable(law).duration()) law_ = law;
  CountAllPoints(last);
  return true;
}

// Searches from the usual knots and, if jerk bounds the motion, from the coarsest ones, too: where
// ramps of acceleration take longer than the knots are apart, moves of few coefficients soon ask
// for too much jerk.
bool TimeLawSearch::SearchAll(int last, double longest) {
  if (!SearchFrom(kFirstLevel, last, longest)) return false;
  const double seconds = TimeTable(law_).duration();
  if (seconds <= kBoundedByJerk * least_seconds_) return true;
  const TimeLaw law = law_;
  if (!SearchFrom(0, last, kAnyDuration) || TimeTable(law_).duration() > seconds) {
    law_ = law;
    CountAllPoints(last);
  }
  return true;
}

// Returns false, too, if the law of the first level takes longer than `longest`.
bool TimeLawSearch::SearchFrom(int first, int last, double longest) {
  law_ = TimeLaw(law_.length(), kCoarsestSpacing);
  for (int level = 0; level < first; ++level) law_.Refine();
  shares_.assign(fastest_.size(), share_);
  for (int level = first; level <= last; ++level) {
    if (level > first) law_.Refine();
    SetLevel(level, last);
    FindLeast();
    if (level == first) Begin();
    if (!MeetLimits()) return false;
    // Large moves were tried on the coarser knots.
    Lower(-1, level > first ? 2 : 0);
    if (level > first) continue;
    first_seconds_ = TimeTable(law_).duration();
    if (first_seconds_ > longest) return false;
  }
  CountAllPoints(last);
  return Repair();
}

// Adapts the search to the last level and to a look at all points.
void TimeLawSearch::CountAllPoints(int last) {
  SetLevel(last, last);
  FindLeast();
  stride_ = 1;
  shares_.assign(fastest_.size(), share_ + kSlack * (1.0 - share_));
}

bool TimeLawSearch::Tighten(const std::vector<LimitPeak>& peaks) {
  for (const LimitPeak& peak : peaks) {
    const auto last = static_cast<Eigen::Index>(shares_.size()) - 1;
    const auto from = static_cast<Eigen::Index>(std::floor(peak.from / path_.step));
    const auto to = static_cast<Eigen::Index>(std::ceil(peak.to / path_.step));
    for (Eigen::Index i = std::max<Eigen::Index>(0, from); i <= std::min(last, to); ++i) {
      double& share = shares_[static_cast<std::size_t>(i)];
      share = std::min(share, kPeakMargin * share_ / peak.ratio);
    }
  }
  return Repair();
}

// Raises the law where it exceeds a limit, then lowers it around there.
bool TimeLawSearch::Repair() {
  const long before = change_;
  if (!MeetLimits()) return false;
  if (change_ > before) Lower(before, 2);
  return true;
}

// Raises the law until all limits hold: where they are exceeded or, if that is faster, as a whole,
// which adds no jerk.
bool TimeLawSearch::MeetLimits() {
  const TimeLaw before = law_;
  const long change = change_;
  std::vector<double> factors(law_.coefficients().size(), 1.0);
  const double worst = FindRaises(std::vector<char>(intervals(), 1), &factors);
  if (worst <= 1.0) return true;
  const bool found = Raise();
  TimeLaw whole = before;
  for (double& c : whole.coefficients()) c *= (1.0 + kTinyRaise) * worst;
  const std::vector<double>& c = whole.coefficients();
  const bool holds = *std::max_element(c.begin(), c.end()) <= kMostSlowness;
  if (!holds || (found && TimeTable(law_).duration() <= TimeTable(whole).duration())) return found;
  law_ = whole;
  change_ = change;
  std::fill(changes_.begin(), changes_.end(), change);
  return true;
}

std::size_t TimeLawSearch::intervals() const {
  return law_.coefficients().size() - kReach;
}

// Returns one past the last point of an interval; the last interval has the end of the path, too.
Eigen::Index TimeLawSearch::EndOf(std::size_t interval) const {
  const Eigen::Index end = static_cast<Eigen::Index>(interval + 1) * per_interval_;
  return interval + 1 == intervals() ? end + 1 : end;
}

TimeLaw::Slowness TimeLawSearch::SlownessAt(std::size_t interval, Eigen::Index point) const {
  const Eigen::Index place = point - static_cast<Eigen::Index>(interval) * per_interval_;
  const TimeLaw::Basis& basis = bases_[static_cast<std::size_t>(place)];
  const double* c = law_.coefficients().data() + interval;
  TimeLaw::Slowness slowness{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < TimeLaw::kSupport; ++k) {
    slowness.value += c[k] * basis.value[k];
    slowness.first += c[k] * basis.first[k];
    slowness.second += c[k] * basis.second[k];
  }
  return slowness;
}

// Adapts the search to the knots of a level. The coarser they are, the fewer points count; all of
// them count in the end.
void TimeLawSearch::SetLevel(int level, int last) {
  per_interval_ = kGridSteps << (kTimeLawLevels - 1 - level);
  stride_ = std::min(kFirstStride, Eigen::Index(2) << (last - level));
  bases_.clear();
  for (Eigen::Index i = 0; i <= per_interval_; ++i) {
    bases_.push_back(law_.BasisAt(static_cast<double>(i) / static_cast<double>(per_interval_)));
  }
  blocking_.assign(intervals(), -1);
  changes_.assign(law_.coefficients().size(), 0);
  change_ = 0;
}

// Computes the lower bound of each coefficient: the largest slowness required on its support.
void TimeLawSearch::FindLeast() {
  least_.assign(law_.coefficients().size(), 0.0);
  for (std::size_t interval = 0; interval < intervals(); ++interval) {
    const auto begin = fastest_.begin() + static_cast<Eigen::Index>(interval) * per_interval_;
    const double least = 1.0 / *std::min_element(begin, fastest_.begin() + EndOf(interval));
    for (std::size_t k = interval; k < interval + TimeLaw::kSupport; ++k) {
      least_[k] = std::max(least_[k], least);
    }
  }
}

// Initializes each coefficient with the mean slowness that velocity and acceleration require near
// its knot.
void TimeLawSearch::Begin() {
  const PathDerivatives path = Thinned(path_, kFirstStride);
  std::vector<double> fastest;
  for (std::size_t i = 0; i < fastest_.size(); i += kFirstStride) fastest.push_back(fastest_[i]);
  const std::vector<double> speeds = MaxPathSpeeds(path, Shared(limits_, share_), fastest);
  std::vector<double>& c = law_.coefficients();
  std::vector<double> sum(c.size(), 0.0), weight(c.size(), 0.0);
  least_seconds_ = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    // Coefficient k belongs to knot k - 1.
    const double place = path.step * static_cast<double>(i) / law_.spacing() + 1.0;
    const auto k = std::min(static_cast<std::size_t>(std::lround(place)), c.size() - 1);
    sum[k] += 1.0 / std::max(speeds[i], 1e-3);
    if (i > 0) least_seconds_ += 2.0 * path.step / std::max(speeds[i - 1] + speeds[i], 1e-3);
    weight[k] += 1.0;
  }
  for (std::size_t k = 0; k < c.size(); ++k) {
    c[k] = std::max(least_[k], weight[k] > 0.0 ? sum[k] / weight[k] : 0.0);
  }
}

// Computes the factors by which the coefficients have to grow, from the points of the intervals
// marked in `changed`, and returns the largest.
double TimeLawSearch::FindRaises(const std::vector<char>& changed,
                                 std::vector<double>* factors) const {
  double most = 1.0;
  for (std::size_t interval = 0; interval < changed.size(); ++interval) {
    if (changed[interval] == 0) continue;
    double worst = 1.0;
    const Eigen::Index end = EndOf(interval);
    for (Eigen::Index i = static_cast<Eigen::Index>(interval) * per_interval_; i < end;
         i += stride_) {
      worst = std::max(worst, path_limits_.Excess(i, SlownessAt(interval, i),
                                                  shares_[static_cast<std::size_t>(i)]));
    }
    if (worst <= 1.0) continue;
    most = std::max(most, worst);
    // A margin of 0.2 %, or the last excess would converge too slowly.
    const double raise = std::min(kLargestRaise, 1.002 * worst);
    for (std::size_t k = interval; k < interval + TimeLaw::kSupport; ++k) {
      (*factors)[k] = std::max((*factors)[k], raise);
    }
  }
  return most;
}

bool TimeLawSearch::Raise() {
  std::vector<double>& c = law_.coefficients();
  std::vector<char> changed(intervals(), 1);
  for (int round = 0; round < kRaisingRounds; ++round) {
    std::vector<double> factors(c.size(), 1.0);
    if (FindRaises(changed, &factors) <= 1.0) return true;
    std::fill(changed.begin(), changed.end(), 0);
    ++change_;
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (factors[k] <= 1.0) continue;
      c[k] *= factors[k];
      changes_[k] = change_;
      if (c[k] > kMostSlowness) return false;
      for (std::size_t i = k - std::min(k, kReach); i <= k; ++i) {
        if (i < changed.size()) changed[i] = 1;
      }
    }
  }
  return false;
}

// Returns true if the limits hold on the intervals `first` to `last`. Most lowerings fail, and at
// the same point as before: these points come first.
bool TimeLawSearch::HoldsOn(std::size_t first, std::size_t last) {
  const auto holds = [&](std::size_t interval, Eigen::Index point) {
    return path_limits_.Hold(point, SlownessAt(interval, point),
                             shares_[static_cast<std::size_t>(point)]);
  };
  for (std::size_t interval = first; interval <= last; ++interval) {
    if (blocking_[interval] >= 0 && !holds(interval, blocking_[interval])) return false;
  }
  for (std::size_t interval = first; interval <= last; ++interval) {
    const Eigen::Index end = EndOf(interval);
    for (Eigen::Index i = static_cast<Eigen::Index>(interval) * per_interval_; i < end;
         i += stride_) {
      if (holds(interval, i)) continue;
      blocking_[interval] = i;
      return false;
    }
  }
  return true;
}

bool TimeLawSearch::TryLower(Stretch stretch, double factor) {
  std::vector<double>& c = law_.coefficients();
  std::array<double, kCounts.front()> before;
  bool lowered = false;
  for (std::size_t i = 0; i < stretch.count; ++i) {
    const std::size_t k = stretch.first + i;
    before[i] = c[k];
    const double taper = Taper(i, stretch.count);
    const double lower =
        std::min(c[k], c[k] - taper * (1.0 - factor) * std::max(0.0, c[k] - least_[k]));
    lowered = lowered || c[k] - lower > 1e-4;
    c[k] = lower;
  }
  const std::size_t last = stretch.first + stretch.count - 1;
  if (lowered &&
      HoldsOn(stretch.first - std::min(stretch.first, kReach), std::min(last, intervals() - 1))) {
    ++change_;
    for (std::size_t k = stretch.first; k <= last; ++k) changes_[k] = change_;
    return true;
  }
  std::copy_n(before.begin(), stretch.count,
              c.begin() + static_cast<std::ptrdiff_t>(stretch.first));
  return false;
}

// Returns the count of changes when a coefficient last changed that decides whether a stretch can
// be lowered.
long TimeLawSearch::LastChange(Stretch stretch) const {
  const auto first = stretch.first - std::min(stretch.first, kReach);
  const auto end = std::min(changes_.size(), stretch.first + stretch.count + kReach);
  return *std::max_element(changes_.begin() + static_cast<std::ptrdiff_t>(first),
                           changes_.begin() + static_cast<std::ptrdiff_t>(end));
}

// Lowers stretches around which a coefficient has changed after the change `since`: twice, the
// second time where one has changed since the first.
void TimeLawSearch::Lower(long since, std::size_t first_factor) {
  const std::size_t size = law_.coefficients().size();
  std::vector<long> tried(kLowered.size() * kCounts.size() * size, since);
  for (int pass = 0; pass < 2; ++pass) {
    auto last_try = tried.begin();
    for (std::size_t f = first_factor; f < kLowered.size(); ++f) {
      for (const std::size_t count : kCounts) {
        const Stretch whole{0, std::min(count, size)};
        const std::size_t hop = std::max<std::size_t>(1, count / 2);
        for (std::size_t first = 0; first + whole.count <= size; first += hop, ++last_try) {
          const Stretch stretch{first, whole.count};
          if (LastChange(stretch) <= *last_try) continue;
          for (int i = 0; i < kTriesAStretch && TryLower(stretch, kLowered[f]); ++i) continue;
          *last_try = change_;
        }
      }
    }
  }
}

}  // namespace simwright::robot
