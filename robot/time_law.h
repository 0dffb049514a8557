#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"
#include "robot/path_speed.h"

namespace simwright::robot {

// The time law of a path: time t as a function of the path parameter w, dt/dw = slowness(w) > 0,
// where slowness is a cubic B-spline on uniform knots over [0, length]. At slowness 1 the path runs
// at its recorded speed, below 1 faster.
class TimeLaw {
 public:
  static constexpr int kSupport = 4;  // coefficients that shape one interval

  // Constructs slowness 1 everywhere, on intervals of about `spacing` s.
  TimeLaw(double length, double spacing);

  double length() const { return length_; }
  double spacing() const { return spacing_; }
  std::vector<double>& coefficients() { return coefficients_; }  // (intervals + 3), each > 0
  const std::vector<double>& coefficients() const { return coefficients_; }

  // Refines the law to twice as many intervals, with the same values.
  void Refine();

  struct Slowness {
    double value = 1.0, first = 0.0, second = 0.0;  // and its derivatives with respect to w
  };
  Slowness At(double w) const;
  // Returns the first three derivatives of the parameter with respect to t, at `w`.
  Eigen::Vector3d Rates(double w) const;

 private:
  double length_, spacing_;
  std::vector<double> coefficients_;
};

// A snapshot of a time law that maps parameters to times and back.
class TimeTable {
 public:
  explicit TimeTable(const TimeLaw& law);

  double duration() const { return knot_times_.back(); }  // s
  double Time(double w) const;                            // 0 at w = 0
  double Parameter(double t) const;                       // the inverse

 private:
  TimeLaw law_;
  std::vector<double> knot_times_;
};

// Returns the number of steps of FitTimeLaw's grid for a path of `length`; the knots, where jerk
// peaks, lie on the grid.
Eigen::Index TimeLawGrid(double length);

struct TimeLawFit {
  TimeLaw law;         // the slowest law tried if none was found
  bool found = false;  // true if all limits hold
};

// Returns a time law that keeps velocity, acceleration and jerk on the grid within `share` of the
// limits, runs the path at w at most fastest(w) times as fast as recorded, and is locally optimal.
// The search starts from the fastest law that velocity and acceleration allow, raises it where a
// limit is exceeded, then lowers it on stretches of decreasing length while all limits hold, on
// `levels` levels of knots, each with half the spacing of the previous one. The finer the knots,
// the more jerk may peak between the points of the grid (TimeLawGrid).
constexpr int kTimeLawLevels = 3;
TimeLawFit FitTimeLaw(const PathDerivatives& path, double length,
                      const std::vector<JointLimits>& limits, double share,
                      const std::function<double(double)>& fastest, int levels = kTimeLawLevels);

}  // namespace simwright::robot
