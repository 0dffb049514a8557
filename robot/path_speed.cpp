#include "robot/path_speed.h"

#include <algorithm>
#include <cmath>

namespace simwright::robot {
namespace {

constexpr double kLeastFirst = 1e-9;  // smaller joint derivatives count as zero
constexpr double kAnyAcceleration = 1e12;
constexpr int kNarrowings = 40;
constexpr double kLeastWidth = 1e-9;  // of accelerations, 1/s^2

// With x = (dw/dt)^2 and u = d2w/dt2, the acceleration of a joint is first * u + second * x, and x
// grows by 2 step u from one point to the next.
class Reachability {
 public:
  Reachability(const PathDerivatives& path, const std::vector<JointLimits>& limits,
               const std::vector<double>& most)
      : path_(path), limits_(limits), most_(most) {}

  std::vector<double> Run() const {
    const Eigen::Index points = path_.first.cols();
    std::vector<double> most(static_cast<std::size_t>(points));
    for (Eigen::Index i = points - 1; i >= 0; --i) {
      const auto at = static_cast<std::size_t>(i);
      most[at] = i + 1 == points ? LargestAlone(i) : LargestBefore(i, most[at + 1]);
    }
    for (Eigen::Index i = 0; i + 1 < points; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double upper = Accelerations(i, most[at]).upper;
      most[at + 1] = std::clamp(most[at] + 2.0 * path_.step * upper, 0.0, most[at + 1]);
    }
    for (double& x : most) x = std::sqrt(x);
    return most;
  }

 private:
  // Returns the largest x within the velocity limits, and within the acceleration limits of joints
  // that turn here.
  double LargestAlone(Eigen::Index point) const {
    double speed = most_[static_cast<std::size_t>(point)];
    double most = speed * speed;
    for (Eigen::Index j = 0; j < path_.first.rows(); ++j) {
      const JointLimits& limit = limits_[static_cast<std::size_t>(j)];
      const double first = std::abs(path_.first(j, point));
      if (first < kLeastFirst) {
        most = std::min(
            most, limit.acceleration / std::max(std::abs(path_.second(j, point)), kLeastFirst));
        continue;
      }
      speed = limit.velocity / first;
      most = std::min(most, speed * speed);
    }
    return most;
  }

  // The smallest and the largest u within the acceleration limits, and their growth with x.
  struct Bounds {
    double lower = -kAnyAcceleration, upper = kAnyAcceleration;
    double lower_slope = 0.0, upper_slope = 0.0;
  };

  // Returns the range of u within the acceleration limits at x; empty if lower > upper.
  Bounds Accelerations(Eigen::Index point, double x) const {
    Bounds bounds;
    for (Eigen::Index j = 0; j < path_.first.rows(); ++j) {
      const double first = path_.first(j, point);
      if (std::abs(first) < kLeastFirst) continue;  // LargestAlone has seen to it
      const double slope = -path_.second(j, point) / first;
      const double slack = limits_[static_cast<std::size_t>(j)].acceleration / std::abs(first);
      if (slope * x - slack > bounds.lower) {
        bounds.lower = slope * x - slack;
        bounds.lower_slope = slope;
      }
      if (slope * x + slack < bounds.upper) {
        bounds.upper = slope * x + slack;
        bounds.upper_slope = slope;
      }
    }
    return bounds;
  }

  // Returns the largest x from which a value in [0, next] of the next point is reachable. The range
  // of u narrows with x from a positive width at 0, piecewise linearly and concavely: Newton's
  // method reaches its end from above in a few steps.
  double LargestBefore(Eigen::Index point, double next) const {
    const double per_step = 1.0 / (2.0 * path_.step);
    double x = LargestAlone(point);
    for (int i = 0; i < kNarrowings; ++i) {
      Bounds bounds = Accelerations(point, x);
      if (-x * per_step > bounds.lower) {
        bounds.lower = -x * per_step;
        bounds.lower_slope = -per_step;
      }
      if ((next - x) * per_step < bounds.upper) {
        bounds.upper = (next - x) * per_step;
        bounds.upper_slope = -per_step;
      }
      const double width = bounds.upper - bounds.lower;
      if (width >= -kLeastWidth) break;
      x = std::max(0.0, x - width / (bounds.upper_slope - bounds.lower_slope));
    }
    return x;
  }

  const PathDerivatives& path_;
  const std::vector<JointLimits>& limits_;
  const std::vector<double>& most_;
};

}  // namespace

std::vector<double> MaxPathSpeeds(const PathDerivatives& path,
                                  const std::vector<JointLimits>& limits,
                                  const std::vector<double>& most) {
  return Reachability(path, limits, most).Run();
}

}  // namespace simwright::robot
