#include "robot/path_speed.h"

#include <algorithm>
#include <cmath>

namespace simwright::robot {
namespace {

constexpr double kLeastFirst = 1e-9;  // smaller joint derivatives count as zero
constexpr int kBisections = 40;

struct Range {
  double lower, upper;
};

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
      most[at] = i + 1 == points ? ByVelocity(i) : LargestBefore(i, most[at + 1]);
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
  // Returns the largest x within the velocity limits.
  double ByVelocity(Eigen::Index point) const {
    double most = std::pow(most_[static_cast<std::size_t>(point)], 2);
    for (Eigen::Index j = 0; j < path_.first.rows(); ++j) {
      const double first = std::abs(path_.first(j, point));
      if (first < kLeastFirst) continue;
      most = std::min(most, std::pow(limits_[static_cast<std::size_t>(j)].velocity / first, 2));
    }
    return most;
  }

  // Returns the range of u within the acceleration limits at x; empty if lower > upper.
  Range Accelerations(Eigen::Index point, double x) const {
    Range range{-1e12, 1e12};
    for (Eigen::Index j = 0; j < path_.first.rows(); ++j) {
      const double limit = limits_[static_cast<std::size_t>(j)].acceleration;
      const double first = path_.first(j, point), curvature = path_.second(j, point) * x;
      if (std::abs(first) < kLeastFirst) {
        if (std::abs(curvature) > limit) return {1.0, -1.0};
        continue;
      }
      const double middle = -curvature / first, slack = limit / std::abs(first);
      range.lower = std::max(range.lower, middle - slack);
      range.upper = std::min(range.upper, middle + slack);
    }
    return range;
  }

  // Returns the largest x from which a value in [0, next] of the next point is reachable. The
  // feasible x form an interval from 0.
  double LargestBefore(Eigen::Index point, double next) const {
    const auto reaches = [&](double x) {
      const Range range = Accelerations(point, x);
      const double lower = std::max(range.lower, -x / (2.0 * path_.step));
      return lower <= std::min(range.upper, (next - x) / (2.0 * path_.step));
    };
    double low = 0.0, high = ByVelocity(point);
    if (reaches(high)) return high;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (reaches(middle) ? low : high) = middle;
    }
    return low;
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
