#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"
#include "robot/path_speed.h"

namespace simwright::robot {

// How slowly a path is run: time t as a function of its parameter w, dt/dw = slowness(w) > 0, a
// cubic B-spline on uniform knots over [0, length]. Where slowness is 1 the path runs as it was
// recorded, where it is less faster.
class TimeLaw {
 public:
  static constexpr int kSupport = 4;  // coefficients that shape one interval

  // Slowness 1 everywhere, on intervals of about `spacing` s.
  TimeLaw(double length, double spacing);

  double length() const { return length_; }
  double spacing() const { return spacing_; }
  std::vector<double>& coefficients() { return coefficients_; }  // (intervals + 3), each > 0
  const std::vector<double>& coefficients() const { return coefficients_; }

  // The same law on twice as many intervals.
  void Refine();

  struct Slowness {
    double value = 1.0, first = 0.0, second = 0.0;  // and its derivatives by w
  };
  Slowness At(double w) const;
  // The parameter's first three derivatives by t, at `w`.
  Eigen::Vector3d Rates(double w) const;

 private:
  double length_, spacing_;
  std::vector<double> coefficients_;
};

// A law ready to be asked for times, as it stands now.
class TimeTable {
 public:
  explicit TimeTable(const TimeLaw& law);

  double duration() const { return knot_times_.back(); }  // s
  double Time(double w) const;                            // from 0 at w = 0
  double Parameter(double t) const;                       // the inverse

 private:
  TimeLaw law_;
  std::vector<double> knot_times_;
};

// Into how many steps FitTimeLaw's grid divides a path of `length`, so that its knots, where jerk
// peaks, lie on the grid.
Eigen::Index TimeLawGrid(double length);

struct TimeLawFit {
  TimeLaw law;         // the slowest that was tried where none was found
  bool found = false;  // it keeps all limits
};

// A law that keeps velocity, acceleration and jerk on the grid within `share` of the limits, runs
// the path at w at most fastest(w) times as fast as it was recorded, and is no slower than local search
// can tell: from the fastest that velocity and acceleration allow, raised where a limit is
// exceeded, then lowered in stretches of decreasing length as far as all limits hold, on `levels` of
// knots, each half as far apart as the last. The finer they are the more jerk may peak between the
// points of the grid, TimeLawGrid.
constexpr int kTimeLawLevels = 3;
TimeLawFit FitTimeLaw(const PathDerivatives& path, double length,
                      const std::vector<JointLimits>& limits, double share,
                      const std::function<double(double)>& fastest, int levels = kTimeLawLevels);

}  // namespace simwright::robot
