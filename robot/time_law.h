#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

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
  // The weights of the coefficients interval ... interval + 3 in slowness and its derivatives at
  // fraction `x` of an interval.
  struct Basis {
    std::array<double, kSupport> value, first, second;
  };
  Basis BasisAt(double x) const;
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
  // Returns the same, faster if `guess` is near.
  double Parameter(double t, double guess) const;

 private:
  TimeLaw law_;
  std::vector<double> knot_times_;
};

}  // namespace simwright::robot
