#include "asset_lift/camera/elevation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/QR>

namespace simwright::asset_lift {
namespace {

constexpr double kElevationDegree = std::numbers::pi / 180.0;
constexpr int kElevations = 81;  // 0 .. 80 degrees

double Halton(int index, int base) {
  double fraction = 1.0, value = 0.0;
  for (int i = index; i > 0; i /= base) {
    fraction /= base;
    value += fraction * (i % base);
  }
  return value;
}

double LogNormal(double x, double mean, double deviation) {
  const double z = (x - mean) / deviation;
  return -0.5 * z * z;
}

// Returns the height over width of the orthographic silhouette of a box or a cylinder from
// elevation `e` at yaw `yaw`.
double OutlineRatio(double length, double width, double height, bool revolved, double e,
                    double yaw) {
  if (revolved) {
    const double across = 0.5 * (length + width);
    return (height * std::cos(e) + across * std::sin(e)) / across;
  }
  const double c = std::abs(std::cos(yaw)), s = std::abs(std::sin(yaw));
  return (height * std::cos(e) + (length * s + width * c) * std::sin(e)) / (length * c + width * s);
}

// Returns log p(observed ratio | elevation), with sizes and yaw integrated out. A real object's
// silhouette is not a box's: 12 % of slack.
std::vector<double> SizeLikelihood(double observed, const CategoryPrior& prior) {
  constexpr int kDraws = 200;
  constexpr double kSlack = 0.12;
  std::vector<double> log_likelihood;
  for (int degrees = 0; degrees < kElevations; ++degrees) {
    double sum = 1e-6;
    for (int i = 1; i <= kDraws; ++i) {
      // Sides are correlated: one sample sets the size, and three small ones vary the proportions.
      const double size = Halton(i, 2);
      const auto draw = [&](double low, double high, int base) {
        const double t = std::clamp(size + 0.5 * (Halton(i, base) - 0.5), 0.0, 1.0);
        return low + t * (high - low);
      };
      const double length = draw(prior.length_min, prior.length_max, 3);
      const double width = std::min(length, draw(prior.width_min, prior.width_max, 5));
      const double height = draw(prior.height_min, prior.height_max, 7);
      // Photos show an object's broad side more often than its end.
      const double yaw = 0.5 * std::numbers::pi * std::pow(Halton(i, 11), 1.3);
      const double ratio = OutlineRatio(length, width, height, prior.revolved || prior.round,
                                        degrees * kElevationDegree, yaw);
      sum += std::exp(LogNormal(std::log(observed), std::log(ratio), kSlack));
    }
    log_likelihood.push_back(std::log(sum / kDraws));
  }
  return log_likelihood;
}

// Returns the last object pixel of each column, from the chosen end; -1 where the column is empty.
std::vector<int> EndProfile(const Matte& matte, bool lower_end) {
  std::vector<int> profile;
  for (int x = matte.left; x < matte.right; ++x) {
    int found = -1;
    for (int i = 0; i < matte.bottom - matte.top && found < 0; ++i) {
      const int y = lower_end ? matte.bottom - 1 - i : matte.top + i;
      if (matte.alpha.At(x, y)[0] > 127) found = y;
    }
    profile.push_back(found);
  }
  return profile;
}

}  // namespace

double EndArcRatio(const Matte& matte, bool lower_end) {
  const std::vector<int> profile = EndProfile(matte, lower_end);
  const double sign = lower_end ? 1.0 : -1.0;
  const int height = matte.bottom - matte.top;
  // The base is the part of the profile within a quarter of the height of the extreme end.
  const int extreme = lower_end ? matte.bottom - 1 : matte.top;
  int first = -1, last = -1;
  for (size_t i = 0; i < profile.size(); ++i) {
    if (profile[i] < 0 || sign * (extreme - profile[i]) > 0.25 * height) continue;
    if (first < 0) first = static_cast<int>(i);
    last = static_cast<int>(i);
  }
  const int span = last - first + 1;
  if (first < 0 || span < 12) return -1.0;
  // y = c + b sqrt(1 - ((x - m) / a)^2) with a, m from the span: linear in c and b. The outer
  // eighths, where the sides begin, are excluded.
  const double a = 0.5 * span, middle = 0.5 * (first + last);
  const int from = first + span / 8, to = last - span / 8;
  Eigen::MatrixX2d system(to - from + 1, 2);
  Eigen::VectorXd values(to - from + 1);
  for (int i = from; i <= to; ++i) {
    const double x = (i - middle) / a;
    system.row(i - from) << 1.0, std::sqrt(std::max(0.0, 1.0 - x * x));
    values[i - from] = sign * profile[static_cast<size_t>(i)];
    if (profile[static_cast<size_t>(i)] < 0) return -1.0;
  }
  const Eigen::Vector2d fit = system.colPivHouseholderQr().solve(values);
  const double residual = (system * fit - values).norm() / std::sqrt(values.size());
  if (residual > 0.03 * span + 0.7) return -1.0;
  return std::clamp(fit[1] / a, 0.0, 1.0);
}

ElevationEstimate EstimateElevation(const Matte& matte, const CategoryPrior& prior) {
  const double observed =
      static_cast<double>(matte.bottom - matte.top) / std::max(1, matte.right - matte.left);
  std::vector<double> log_posterior = SizeLikelihood(observed, prior);
  const double habit = prior.flat ? 38.0 : prior.round ? 18.0 : 22.0;
  const double habit_deviation = prior.flat ? 16.0 : 13.0;
  std::string cues = "habit and proportions";
  std::vector<std::pair<double, double>> arcs;  // (elevation, deviation), degrees
  if (prior.revolved && !prior.round) {
    const double base = EndArcRatio(matte, true);
    if (base >= 0.0) {
      // Rounded bases and perspective widen the arc: it is an upper bound more than an estimate.
      arcs.emplace_back(std::asin(base) / kElevationDegree - 3.0, 8.0);
      cues += ", curve of the base";
    }
    const double rim = prior.open ? EndArcRatio(matte, false) : -1.0;
    if (rim >= 0.0) {
      arcs.emplace_back(std::asin(rim) / kElevationDegree, 4.0);
      cues += ", curve of the rim";
    }
  }
  double best = -1e300;
  for (int i = 0; i < kElevations; ++i) {
    log_posterior[i] += LogNormal(i, habit, habit_deviation);
    for (const auto& [elevation, deviation] : arcs) {
      // Heavy tails: a lip, a foot ring or a leaf can make an unrelated arc.
      const double z = (i - elevation) / deviation;
      log_posterior[i] += -1.5 * std::log1p(z * z / 2.0);
    }
    best = std::max(best, log_posterior[i]);
  }
  double total = 0.0, mean = 0.0, square = 0.0;
  for (int i = 0; i < kElevations; ++i) {
    const double weight = std::exp(log_posterior[i] - best);
    total += weight;
    mean += weight * i;
    square += weight * i * i;
  }
  mean /= total;
  ElevationEstimate estimate;
  estimate.elevation = mean * kElevationDegree;
  estimate.deviation = std::sqrt(std::max(0.0, square / total - mean * mean)) * kElevationDegree;
  char text[160];
  std::snprintf(text, sizeof(text), "%.0f +- %.0f degrees from %s", mean,
                estimate.deviation / kElevationDegree, cues.c_str());
  estimate.sentence = text;
  return estimate;
}

ElevationEstimate Combined(const ElevationEstimate& a, const ElevationEstimate& b) {
  const double precision_a = 1.0 / (a.deviation * a.deviation),
               precision_b = 1.0 / (b.deviation * b.deviation),
               precision = precision_a + precision_b;
  const double share_a = precision_a / precision, share_b = precision_b / precision;
  const double apart = a.elevation - b.elevation;
  ElevationEstimate joint;
  joint.elevation = share_a * a.elevation + share_b * b.elevation;
  joint.deviation = std::sqrt(1.0 / precision + share_a * share_b * apart * apart);
  char text[400];
  std::snprintf(text, sizeof(text), "%.0f +- %.0f degrees: %s; %s",
                joint.elevation / kElevationDegree, joint.deviation / kElevationDegree,
                a.sentence.c_str(), b.sentence.c_str());
  joint.sentence = text;
  return joint;
}

}  // namespace simwright::asset_lift
