#include "robot/time_law.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace simwright::robot {
namespace {

constexpr double kSpacing = 0.03;  // s between knots of the slowness
constexpr int kRaisingRounds = 400;
constexpr double kLargestRaise = 1.5;  // in one iteration
constexpr double kMostSlowness = 1e4;
constexpr int kLongestStretch = 32;  // most coefficients lowered together
constexpr std::array<double, 4> kLowered = {0.7, 0.85, 0.93, 0.98};
constexpr double kGridSteps = 8;  // grid steps between the finest knots

// The pieces of the cardinal cubic B-spline over one interval, times 6: coefficients of 1, x, x^2,
// x^3.
constexpr double kPieces[4][4] = {{1, -3, 3, -1}, {4, 0, -6, 3}, {1, 3, 3, -3}, {0, 0, 0, 1}};

struct Place {
  std::size_t interval;
  double x;  // in [0, 1]
};

Place PlaceOf(double w, double spacing, std::size_t intervals) {
  const double place = std::clamp(w / spacing, 0.0, static_cast<double>(intervals));
  const std::size_t interval = std::min(static_cast<std::size_t>(place), intervals - 1);
  return {interval, place - static_cast<double>(interval)};
}

// Returns the time in s from the start of `interval` to its fraction `x`.
double TimeInInterval(const std::vector<double>& coefficients, std::size_t interval, double x,
                      double spacing) {
  double sum = 0.0;
  for (std::size_t k = 0; k < TimeLaw::kSupport; ++k) {
    const double* p = kPieces[k];
    const double integral = x * (p[0] + x * (p[1] / 2 + x * (p[2] / 3 + x * p[3] / 4)));
    sum += coefficients[interval + k] / 6.0 * integral;
  }
  return spacing * sum;
}

}  // namespace

TimeLaw::TimeLaw(double length, double spacing) : length_(length) {
  const double intervals = std::max(1.0, std::round(length / spacing));
  spacing_ = length / intervals;
  coefficients_.assign(static_cast<std::size_t>(intervals) + kSupport - 1, 1.0);
}

// Coefficient k belongs to knot k - 1. Subdivision of cubic B-splines keeps the curve.
void TimeLaw::Refine() {
  const std::vector<double> coarse = coefficients_;
  const std::size_t intervals = coarse.size() - (kSupport - 1);
  spacing_ *= 0.5;
  coefficients_.resize(2 * intervals + kSupport - 1);
  for (std::size_t k = 0; k + 1 < coarse.size(); ++k) {
    coefficients_[2 * k] = 0.5 * (coarse[k] + coarse[k + 1]);
    if (k == 0) continue;
    coefficients_[2 * k - 1] = (coarse[k - 1] + 6.0 * coarse[k] + coarse[k + 1]) / 8.0;
  }
}

TimeLaw::Slowness TimeLaw::At(double w) const {
  const auto [interval, x] = PlaceOf(w, spacing_, coefficients_.size() - (kSupport - 1));
  Slowness slowness{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < kSupport; ++k) {
    const double c = coefficients_[interval + k] / 6.0;
    const double* p = kPieces[k];
    slowness.value += c * (p[0] + x * (p[1] + x * (p[2] + x * p[3])));
    slowness.first += c * (p[1] + x * (2.0 * p[2] + x * 3.0 * p[3]));
    slowness.second += c * (2.0 * p[2] + x * 6.0 * p[3]);
  }
  slowness.first /= spacing_;
  slowness.second /= spacing_ * spacing_;
  return slowness;
}

Eigen::Vector3d TimeLaw::Rates(double w) const {
  const Slowness s = At(w);
  const double rate = 1.0 / s.value;
  return {rate, -s.first * std::pow(rate, 3),
          (3.0 * s.first * s.first - s.value * s.second) * std::pow(rate, 5)};
}

TimeTable::TimeTable(const TimeLaw& law) : law_(law), knot_times_{0.0} {
  const std::vector<double>& c = law_.coefficients();
  for (std::size_t interval = 0; interval + TimeLaw::kSupport <= c.size(); ++interval) {
    knot_times_.push_back(knot_times_.back() + TimeInInterval(c, interval, 1.0, law_.spacing()));
  }
}

double TimeTable::Time(double w) const {
  const auto [interval, x] = PlaceOf(w, law_.spacing(), knot_times_.size() - 1);
  return knot_times_[interval] + TimeInInterval(law_.coefficients(), interval, x, law_.spacing());
}

// Newton's method inside the interval that contains `t`, safeguarded by bisection.
double TimeTable::Parameter(double t) const {
  if (t <= 0.0) return 0.0;
  if (t >= duration()) return law_.length();
  const auto after = std::upper_bound(knot_times_.begin(), knot_times_.end(), t);
  const auto interval = static_cast<double>(after - knot_times_.begin() - 1);
  double low = interval * law_.spacing(), high = low + law_.spacing();
  double w = low;
  for (int i = 0; i < 60; ++i) {
    const double miss = Time(w) - t;
    (miss > 0.0 ? high : low) = w;
    double next = w - miss / law_.At(w).value;
    if (next < low || next > high) next = 0.5 * (low + high);
    if (std::abs(next - w) <= 1e-15 * law_.length()) return next;
    w = next;
  }
  return w;
}

namespace {

class Search {
 public:
  Search(const PathDerivatives& path, double length, const std::vector<JointLimits>& limits,
         double share, const std::function<double(double)>& fastest, int levels)
      : path_(path), law_(length, kSpacing), limits_(limits), levels_(levels) {
    for (Eigen::Index point = 0; point < points(); ++point) {
      fastest_.push_back(fastest(ParameterAt(point)));
    }
    for (JointLimits& limit : limits_) {
      limit.velocity *= share;
      limit.acceleration *= share;
      limit.jerk *= share;
    }
  }

  TimeLawFit Run() {
    FindLeast();
    Begin();
    const bool found = Raise();
    for (int level = 0; found && level < levels_; ++level) {
      if (level > 0) law_.Refine();
      FindLeast();
      Lower();
      Lower();
    }
    return {law_, found};
  }

 private:
  Eigen::Index points() const { return path_.first.cols(); }
  double ParameterAt(Eigen::Index point) const {
    return std::min(path_.step * static_cast<double>(point), law_.length());
  }
  double Excess(Eigen::Index point) const;
  bool HoldsBetween(double from, double to) const;
  void FindLeast();
  void Begin();
  bool Raise();
  void Lower();
  bool TryLower(std::size_t first, std::size_t count, double factor);

  const PathDerivatives& path_;
  TimeLaw law_;
  std::vector<JointLimits> limits_;
  int levels_;
  std::vector<double> fastest_;  // (points) largest speed-up over the recording
  std::vector<double> least_;    // lower bound of each coefficient
};

// Returns the factor by which the path would have to be slower at `point` if the slowness were
// uniform: velocity falls with it, acceleration with its square, jerk with its cube.
double Search::Excess(Eigen::Index point) const {
  const Eigen::Vector3d rate = law_.Rates(ParameterAt(point));
  double most = 0.0;
  for (Eigen::Index j = 0; j < path_.first.rows(); ++j) {
    const JointLimits& limit = limits_[static_cast<std::size_t>(j)];
    const double d1 = path_.first(j, point), d2 = path_.second(j, point);
    const double velocity = std::abs(d1 * rate[0]) / limit.velocity;
    const double acceleration =
        std::abs(d2 * rate[0] * rate[0] + d1 * rate[1]) / limit.acceleration;
    const double jerk = std::abs(path_.third(j, point) * rate[0] * rate[0] * rate[0] +
                                 3.0 * d2 * rate[0] * rate[1] + d1 * rate[2]) /
                        limit.jerk;
    // Roots only where they matter: below 1 the largest ratio suffices.
    double excess = std::max({velocity, acceleration, jerk});
    if (excess > 1.0) excess = std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
    most = std::max(most, excess);
  }
  return most;
}

bool Search::HoldsBetween(double from, double to) const {
  const Eigen::Index first =
      std::max<Eigen::Index>(0, static_cast<Eigen::Index>(from / path_.step));
  const Eigen::Index last =
      std::min(points() - 1, static_cast<Eigen::Index>(std::ceil(to / path_.step)));
  for (Eigen::Index point = first; point <= last; ++point) {
    if (Excess(point) > 1.0) return false;
  }
  return true;
}

// Computes the lower bound of each coefficient: the largest slowness required on its support.
void Search::FindLeast() {
  const auto size = static_cast<std::ptrdiff_t>(law_.coefficients().size());
  least_.assign(static_cast<std::size_t>(size), 0.0);
  for (Eigen::Index point = 0; point < points(); ++point) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(
        PlaceOf(ParameterAt(point), law_.spacing(),
                static_cast<std::size_t>(size - (TimeLaw::kSupport - 1)))
            .interval);
    for (std::ptrdiff_t k = first; k < first + TimeLaw::kSupport; ++k) {
      double& least = least_[static_cast<std::size_t>(k)];
      least = std::max(least, 1.0 / fastest_[static_cast<std::size_t>(point)]);
    }
  }
}

// Initializes each coefficient with the mean slowness that velocity and acceleration require near
// its knot.
void Search::Begin() {
  const std::vector<double> speeds = MaxPathSpeeds(path_, limits_, fastest_);
  std::vector<double>& c = law_.coefficients();
  std::vector<double> sum(c.size(), 0.0), weight(c.size(), 0.0);
  for (Eigen::Index point = 0; point < points(); ++point) {
    // Coefficient k belongs to knot k - 1.
    const double place = ParameterAt(point) / law_.spacing() + 1.0;
    const auto k = std::min(static_cast<std::size_t>(std::lround(place)), c.size() - 1);
    const double speed = speeds[static_cast<std::size_t>(point)];
    sum[k] += 1.0 / std::max(speed, 1e-3);
    weight[k] += 1.0;
  }
  for (std::size_t k = 0; k < c.size(); ++k) {
    c[k] = std::max(least_[k], weight[k] > 0.0 ? sum[k] / weight[k] : 0.0);
  }
}

bool Search::Raise() {
  std::vector<double>& c = law_.coefficients();
  for (int round = 0; round < kRaisingRounds; ++round) {
    std::vector<double> factor(c.size(), 1.0);
    double worst = 1.0;
    for (Eigen::Index point = 0; point < points(); ++point) {
      const double excess = Excess(point);
      if (excess <= 1.0) continue;
      worst = std::max(worst, excess);
      const double w = ParameterAt(point);
      // A margin of 0.2 %, or the last excess would converge too slowly.
      const double raise = std::min(kLargestRaise, 1.002 * excess);
      const std::size_t first =
          PlaceOf(w, law_.spacing(), c.size() - (TimeLaw::kSupport - 1)).interval;
      for (std::size_t k = first; k < first + TimeLaw::kSupport; ++k) {
        factor[k] = std::max(factor[k], raise);
      }
    }
    if (worst <= 1.0) return true;
    for (std::size_t k = 0; k < c.size(); ++k) c[k] *= factor[k];
    if (*std::max_element(c.begin(), c.end()) > kMostSlowness) return false;
  }
  return false;
}

bool Search::TryLower(std::size_t first, std::size_t count, double factor) {
  std::vector<double>& c = law_.coefficients();
  const std::vector<double> before(c.begin() + static_cast<std::ptrdiff_t>(first),
                                   c.begin() + static_cast<std::ptrdiff_t>(first + count));
  bool lowered = false;
  for (std::size_t k = first; k < first + count; ++k) {
    const double lower = std::min(c[k], least_[k] + factor * std::max(0.0, c[k] - least_[k]));
    lowered = lowered || c[k] - lower > 1e-4;
    c[k] = lower;
  }
  // Coefficient k shapes the intervals k - 3 to k.
  const double from = (static_cast<double>(first) - 3.0) * law_.spacing();
  const double to = static_cast<double>(first + count) * law_.spacing();
  if (lowered && HoldsBetween(from, to)) return true;
  std::copy(before.begin(), before.end(), c.begin() + static_cast<std::ptrdiff_t>(first));
  return false;
}

void Search::Lower() {
  const std::size_t size = law_.coefficients().size();
  for (const double factor : kLowered) {
    for (std::size_t count = kLongestStretch; count >= 1; count /= 2) {
      const std::size_t hop = std::max<std::size_t>(1, count / 2);
      for (std::size_t first = 0; first + std::min(count, size) <= size; first += hop) {
        for (int i = 0; i < 8 && TryLower(first, std::min(count, size), factor); ++i) continue;
      }
    }
  }
}

}  // namespace

Eigen::Index TimeLawGrid(double length) {
  const double knots = std::max(1.0, std::round(length / kSpacing));
  return static_cast<Eigen::Index>(knots * kGridSteps * (1 << (kTimeLawLevels - 1)));
}

TimeLawFit FitTimeLaw(const PathDerivatives& path, double length,
                      const std::vector<JointLimits>& limits, double share,
                      const std::function<double(double)>& fastest, int levels) {
  return Search(path, length, limits, share, fastest, levels).Run();
}

}  // namespace simwright::robot
