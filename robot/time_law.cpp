#include "robot/time_law.h"

#include <algorithm>
#include <cmath>

namespace simwright::robot {
namespace {

constexpr int kNewtonSteps = 4;
constexpr double kSmallStep = 1e-7;  // of the knots' spacing

// The pieces of the cardinal cubic B-spline over one interval, times 6: coefficients of 1, x, x^2,
// x^3.
constexpr double kCubicPieces[4][4] = {{1, -3, 3, -1}, {4, 0, -6, 3}, {1, 3, 3, -3}, {0, 0, 0, 1}};

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
    const double* p = kCubicPieces[k];
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

TimeLaw::Basis TimeLaw::BasisAt(double x) const {
  Basis basis;
  for (std::size_t k = 0; k < kSupport; ++k) {
    const double* p = kCubicPieces[k];
    basis.value[k] = (p[0] + x * (p[1] + x * (p[2] + x * p[3]))) / 6.0;
    basis.first[k] = (p[1] + x * (2.0 * p[2] + x * 3.0 * p[3])) / (6.0 * spacing_);
    basis.second[k] = (2.0 * p[2] + x * 6.0 * p[3]) / (6.0 * spacing_ * spacing_);
  }
  return basis;
}

TimeLaw::Slowness TimeLaw::At(double w) const {
  const auto [interval, x] = PlaceOf(w, spacing_, coefficients_.size() - (kSupport - 1));
  const Basis basis = BasisAt(x);
  Slowness slowness{0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < kSupport; ++k) {
    const double c = coefficients_[interval + k];
    slowness.value += c * basis.value[k];
    slowness.first += c * basis.first[k];
    slowness.second += c * basis.second[k];
  }
  return slowness;
}

Eigen::Vector3d TimeLaw::Rates(double w) const {
  const Slowness s = At(w);
  const double rate = 1.0 / s.value;
  const double cube = rate * rate * rate;
  return {rate, -s.first * cube,
          (3.0 * s.first * s.first - s.value * s.second) * cube * rate * rate};
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

double TimeTable::Parameter(double t, double guess) const {
  if (t <= 0.0 || t >= duration()) return Parameter(t);
  double w = guess;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double step = (Time(w) - t) / law_.At(w).value;
    w -= step;
    // Newton's method squares the error: the next step would be of the size of rounding.
    if (std::abs(step) < kSmallStep * law_.spacing()) return std::clamp(w, 0.0, law_.length());
  }
  return Parameter(t);
}

}  // namespace simwright::robot
