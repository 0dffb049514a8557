#include "robot/retiming.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "robot/limit_check.h"
#include "robot/number_text.h"
#include "robot/quintic_spline.h"
#include "robot/time_law.h"
#include "robot/time_law_search.h"
#include "robot/tube_fit.h"

namespace simwright::robot {
namespace {

constexpr Eigen::Index kLeastPositions = 4;
constexpr Eigen::Index kMostPositions = 500000;
constexpr double kMostUneven = 3.0;   // largest time step over the mean
constexpr double kShare = 0.998;      // used share of the limits: peaks lie between grid points
constexpr double kLessShare = 0.995;  // factor on the share for each retry
constexpr int kRefinements = 12;
constexpr int kTightenings = 8;
constexpr int kTriesALevel = 3;
constexpr double kLeastShare = 0.02;  // smallest share of a joint's deviation that the tool leaves
                                      // it
constexpr int kFinest = 4;            // most knots of the smooth curve per recorded position

[[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") {
  throw core::Error(what, "retiming", remedy);
}

std::string At(const RecordedPath& path, Eigen::Index j, Eigen::Index k) {
  return "joint '" + path.joints[static_cast<std::size_t>(j)] + "' at " +
         DisplayText(path.times[static_cast<std::size_t>(k)]) + " s";
}

void RequireShape(const RecordedPath& path, const std::vector<JointLimits>& limits,
                  const std::vector<bool>& sliding) {
  const auto joints = static_cast<Eigen::Index>(path.joints.size());
  const auto count = static_cast<Eigen::Index>(path.times.size());
  if (joints == 0 || path.positions.cols() != joints || path.positions.rows() != count ||
      limits.size() != path.joints.size() || sliding.size() != path.joints.size()) {
    Fail("the sizes of names, times, positions and limits differ");
  }
  const bool paced = std::all_of(path.speed_ups.begin(), path.speed_ups.end(),
                                 [](double pace) { return pace > 0.0 && std::isfinite(pace); });
  if (!paced || (!path.speed_ups.empty() && path.speed_ups.size() != path.times.size())) {
    Fail("the paces are not one positive number per position");
  }
  if (count < kLeastPositions || count > kMostPositions) {
    Fail("the recording has " + std::to_string(count) + " positions",
         "give " + std::to_string(kLeastPositions) + " to " + std::to_string(kMostPositions));
  }
  for (std::size_t j = 0; j < limits.size(); ++j) {
    const JointLimits& limit = limits[j];
    if (limit.lower < limit.upper && limit.velocity > 0.0 && limit.acceleration > 0.0 &&
        limit.jerk > 0.0) {
      continue;
    }
    Fail("the limits of joint '" + path.joints[j] + "' allow no motion");
  }
}

void RequireEvenTimes(const RecordedPath& path) {
  const double mean =
      (path.times.back() - path.times.front()) / static_cast<double>(path.times.size() - 1);
  for (std::size_t k = 0; k < path.times.size(); ++k) {
    const double step = k == 0 ? mean : path.times[k] - path.times[k - 1];
    if (std::isfinite(path.times[k]) && step > 0.0 && step <= kMostUneven * mean) continue;
    Fail("the time of position " + std::to_string(k) + ", " + DisplayText(path.times[k]) +
             " s, is not evenly spaced from the previous one",
         "record at a constant rate");
  }
}

void RequirePossible(const RecordedPath& path, const std::vector<JointLimits>& limits,
                     const std::vector<bool>& sliding, const RetimingOptions& options) {
  for (Eigen::Index j = 0; j < path.positions.cols(); ++j) {
    const bool slides = sliding[static_cast<std::size_t>(j)];
    const JointLimits& limit = limits[static_cast<std::size_t>(j)];
    const double deviation = slides ? options.prismatic_deviation : options.revolute_deviation;
    const double longest = slides ? options.max_prismatic_step : options.max_revolute_step;
    for (Eigen::Index k = 0; k < path.positions.rows(); ++k) {
      const double q = path.positions(k, j);
      if (!std::isfinite(q)) Fail(At(path, j, k) + " is not finite");
      if (q < limit.lower - deviation || q > limit.upper + deviation) {
        Fail(At(path, j, k) + " is at " + DisplayText(q) + ", outside its limits " +
                 DisplayText(limit.lower) + " to " + DisplayText(limit.upper),
             "record a motion within them");
      }
      const double step = k == 0 ? 0.0 : std::abs(q - path.positions(k - 1, j));
      if (step > longest) {
        Fail(At(path, j, k) + " jumps by " + DisplayText(step) + ", more than " +
                 DisplayText(longest),
             "record it as one motion without resets");
      }
    }
  }
}

// A reparameterization that starts and ends a curve of length L at rest: u(w) rises from 0 to L
// over w in [0, L + ramp], with u' = 0 at the ends and 1 between the ramps; u' follows x^3 (10 - 15
// x + 6 x^2), so that u is three times continuously differentiable.
class RestToRest {
 public:
  RestToRest(double length, double ramp) : length_(length), ramp_(std::min(ramp, length)) {}

  double length() const { return length_ + ramp_; }
  // Returns u and its first three derivatives at w.
  Eigen::Vector4d At(double w) const {
    if (w > 0.5 * length()) {
      const Eigen::Vector4d mirrored = Start(length() - w);
      return {length_ - mirrored[0], mirrored[1], -mirrored[2], mirrored[3]};
    }
    return Start(w);
  }
  double Parameter(double u) const {
    if (u > 0.5 * length_) return length() - StartParameter(length_ - u);
    return StartParameter(u);
  }

 private:
  Eigen::Vector4d Start(double w) const {
    if (w >= ramp_) return {w - 0.5 * ramp_, 1.0, 0.0, 0.0};
    const double x = std::max(0.0, w) / ramp_;
    return {ramp_ * x * x * x * x * (2.5 + x * (x - 3.0)),
            x * x * x * (10.0 + x * (6.0 * x - 15.0)), 30.0 * x * x * (1.0 + x * (x - 2.0)) / ramp_,
            60.0 * x * (1.0 + x * (2.0 * x - 3.0)) / (ramp_ * ramp_)};
  }
  double StartParameter(double u) const {
    if (u >= 0.5 * ramp_) return u + 0.5 * ramp_;
    double low = 0.0, high = ramp_;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (Start(middle)[0] < u ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  double length_, ramp_;
};

// The retiming of one recorded motion.
class Retiming {
 public:
  Retiming(const RecordedPath& path, const std::vector<JointLimits>& limits,
           const std::vector<bool>& sliding, const Arm* arm, const RetimingOptions& options)
      : path_(path), limits_(limits), sliding_(sliding), arm_(arm), options_(options) {
    for (const double time : path.times) parameters_.push_back(time - path.times.front());
    weights_.resize(path.joints.size());
    if (arm_ == nullptr) return;
    FindArm();
    tools_.resize(3, path.positions.rows());
    for (Eigen::Index k = 0; k < tools_.cols(); ++k) {
      tools_.col(k) =
          ForwardKinematics(*arm_, ArmConfiguration(path.positions.row(k))).translation();
    }
  }
  Retimed Run();

 private:
  void FindArm();
  Eigen::VectorXd ArmConfiguration(const Eigen::RowVectorXd& row) const;
  double Allowed(Eigen::Index joint) const;
  Eigen::MatrixXd Controls(const Eigen::VectorXd& shares, int fineness, Eigen::Index* failed);
  QuinticSpline Fit(const Eigen::VectorXd& shares);
  QuinticSpline FitPath(Retimed* result);
  void Measure(const QuinticSpline& curve, Retimed* result) const;
  PathDerivatives Derivatives(const QuinticSpline& curve, const RestToRest& ends) const;
  std::vector<double> Paces(const PathDerivatives& grid, const RestToRest& ends) const;
  JointTrajectory Sample(const QuinticSpline& curve, const RestToRest& ends, TimeLaw* law,
                         std::vector<double>* parameters) const;
  std::vector<LimitPeak> Peaks(const JointTrajectory& trajectory,
                               const std::vector<double>& parameters) const;
  bool Finish(const QuinticSpline& curve, const RestToRest& ends, TimeLawSearch* search,
              Retimed* result) const;
  [[noreturn]] void FailLimits(const PathDerivatives& derivatives, const RestToRest& ends) const;

  const RecordedPath& path_;
  const std::vector<JointLimits>& limits_;
  const std::vector<bool>& sliding_;
  const Arm* arm_;
  const RetimingOptions& options_;
  std::vector<double> parameters_;          // (K) s since the first position
  std::vector<Eigen::Index> arm_channels_;  // the arm's joints in the path
  std::vector<Eigen::VectorXd> weights_;    // (J) of the samples in the last fit
  Eigen::Matrix3Xd tools_;                  // (3 x K) recorded tool positions, m; empty without arm
};

void Retiming::FindArm() {
  for (const ArmJoint& joint : arm_->joints) {
    const auto found = std::find(path_.joints.begin(), path_.joints.end(), joint.name);
    if (found == path_.joints.end())
      Fail("the recording lacks the arm's joint '" + joint.name + "'");
    arm_channels_.push_back(found - path_.joints.begin());
  }
}

Eigen::VectorXd Retiming::ArmConfiguration(const Eigen::RowVectorXd& row) const {
  Eigen::VectorXd q(static_cast<Eigen::Index>(arm_channels_.size()));
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = row[arm_channels_[static_cast<std::size_t>(j)]];
  return q;
}

double Retiming::Allowed(Eigen::Index joint) const {
  return sliding_[static_cast<std::size_t>(joint)] ? options_.prismatic_deviation
                                                   : options_.revolute_deviation;
}

// Returns the control points of a smooth curve for each joint, with `fineness` knots per recorded
// position, within its share (J) of the allowed deviation. Empty, with the joint in `failed`, if
// there is none.
Eigen::MatrixXd Retiming::Controls(const Eigen::VectorXd& shares, int fineness,
                                   Eigen::Index* failed) {
  const double spacing = parameters_.back() / static_cast<double>(parameters_.size() - 1);
  Eigen::MatrixXd controls;
  for (Eigen::Index j = 0; j < path_.positions.cols(); ++j) {
    const JointLimits& limits = limits_[static_cast<std::size_t>(j)];
    const Tube tube{shares[j] * Allowed(j), limits.lower, limits.upper};
    // Weights of other knots would fit no better than none.
    Eigen::VectorXd none;
    Eigen::VectorXd* weights = fineness == 1 ? &weights_[static_cast<std::size_t>(j)] : &none;
    const Eigen::VectorXd fitted =
        FitWithinTube(parameters_, path_.positions.col(j), spacing / fineness, tube, weights);
    *failed = j;
    if (fitted.size() == 0) return {};
    if (j == 0) controls.resize(fitted.size(), path_.positions.cols());
    controls.col(j) = fitted;
  }
  return controls;
}

QuinticSpline Retiming::Fit(const Eigen::VectorXd& shares) {
  Eigen::Index failed = 0;
  for (int fineness = 1; fineness <= kFinest; fineness *= 2) {
    Eigen::MatrixXd controls = Controls(shares, fineness, &failed);
    if (controls.size() == 0) continue;
    const auto intervals = static_cast<double>(parameters_.size() - 1) * fineness;
    return QuinticSpline(parameters_.back() / intervals, std::move(controls));
  }
  Fail("joint '" + path_.joints[static_cast<std::size_t>(failed)] +
           "' has no smooth motion within the allowed deviation from its recording",
       "allow more deviation");
}

void Retiming::Measure(const QuinticSpline& curve, Retimed* result) const {
  result->deviations = Eigen::VectorXd::Zero(path_.positions.cols());
  result->tool_deviation = 0.0;
  for (Eigen::Index k = 0; k < path_.positions.rows(); ++k) {
    const Eigen::RowVectorXd value = curve.Value(parameters_[static_cast<std::size_t>(k)]);
    const Eigen::RowVectorXd recorded = path_.positions.row(k);
    result->deviations = result->deviations.cwiseMax((value - recorded).cwiseAbs().transpose());
    if (arm_ == nullptr) continue;
    const Eigen::Vector3d tool = ForwardKinematics(*arm_, ArmConfiguration(value)).translation();
    result->tool_deviation = std::max(result->tool_deviation, (tool - tools_.col(k)).norm());
  }
}

// Tightens the deviation of every joint that moves the tool until the tool keeps its own deviation
// too.
QuinticSpline Retiming::FitPath(Retimed* result) {
  Eigen::VectorXd shares = Eigen::VectorXd::Ones(path_.positions.cols());
  for (int i = 0; i < kRefinements; ++i) {
    const QuinticSpline curve = Fit(shares);
    Measure(curve, result);
    if (result->tool_deviation <= options_.tool_deviation) return curve;
    const double factor = std::max(0.3, 0.9 * options_.tool_deviation / result->tool_deviation);
    for (const Eigen::Index j : arm_channels_) {
      const double used = result->deviations[j] / Allowed(j);
      shares[j] = std::max(kLeastShare, factor * std::min(shares[j], used));
    }
  }
  Fail("the tool deviates by " + DisplayText(result->tool_deviation) +
           " m from the recording, more than " + DisplayText(options_.tool_deviation),
       "allow more deviation, or record a motion within the joints' limits");
}

PathDerivatives Retiming::Derivatives(const QuinticSpline& curve, const RestToRest& ends) const {
  const Eigen::Index points = TimeLawGrid(ends.length()) + 1;
  PathDerivatives path;
  path.step = ends.length() / static_cast<double>(points - 1);
  for (Eigen::MatrixXd* matrix : {&path.first, &path.second, &path.third}) {
    matrix->resize(curve.joints(), points);
  }
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::Vector4d u = ends.At(path.step * static_cast<double>(i));
    const QuinticSpline::Jet jet = curve.Values(u[0]);
    const auto d1 = jet.row(1).transpose(), d2 = jet.row(2).transpose(),
               d3 = jet.row(3).transpose();
    path.first.col(i) = d1 * u[1];
    path.second.col(i) = d2 * u[1] * u[1] + d1 * u[2];
    path.third.col(i) = d3 * u[1] * u[1] * u[1] + 3.0 * d2 * u[1] * u[2] + d1 * u[3];
  }
  return path;
}

// Returns the largest speed-up over the recording at each point of the grid.
std::vector<double> Retiming::Paces(const PathDerivatives& grid, const RestToRest& ends) const {
  std::vector<double> paces(static_cast<std::size_t>(grid.first.cols()), options_.max_speed_up);
  if (path_.speed_ups.empty()) return paces;
  std::size_t next = 0;
  for (std::size_t i = 0; i < paces.size(); ++i) {
    const double u = ends.At(grid.step * static_cast<double>(i))[0];
    while (next + 1 < parameters_.size() && parameters_[next] <= u) ++next;
    const std::size_t last = next > 0 ? next - 1 : 0;
    paces[i] = std::min({paces[i], path_.speed_ups[last], path_.speed_ups[next]});
  }
  return paces;
}

// Samples the trajectory at the requested rate, with the path parameter of each sample; the law is
// slowed by less than a sample so that the last sample falls on the end.
JointTrajectory Retiming::Sample(const QuinticSpline& curve, const RestToRest& ends, TimeLaw* law,
                                 std::vector<double>* parameters) const {
  const double exact = TimeTable(*law).duration() * options_.rate;
  const auto steps = static_cast<Eigen::Index>(std::ceil(exact - 1e-9));
  for (double& c : law->coefficients()) c *= static_cast<double>(steps) / exact;
  const TimeTable table(*law);
  JointTrajectory trajectory;
  trajectory.joints = path_.joints;
  for (Eigen::MatrixXd* matrix :
       {&trajectory.positions, &trajectory.velocities, &trajectory.accelerations}) {
    matrix->resize(steps + 1, curve.joints());
  }
  parameters->clear();
  const double h = 1.0 / options_.rate;
  double w = 0.0, guess = 0.0;
  for (Eigen::Index i = 0; i <= steps; ++i) {
    const double time = static_cast<double>(i) / options_.rate;
    w = i == steps ? ends.length() : table.Parameter(time, guess);
    const Eigen::Vector4d u = ends.At(w);
    const Eigen::Vector3d rate = law->Rates(w);
    guess = w + h * (rate[0] + h * (rate[1] / 2.0 + h * rate[2] / 6.0));
    const double first = u[1] * rate[0];
    const double second = u[2] * rate[0] * rate[0] + u[1] * rate[1];
    const QuinticSpline::Jet jet = curve.Values(u[0]);
    parameters->push_back(w);
    trajectory.times.push_back(time);
    trajectory.positions.row(i) = jet.row(0);
    trajectory.velocities.row(i) = jet.row(1) * first;
    trajectory.accelerations.row(i) = jet.row(2) * first * first + jet.row(1) * second;
  }
  return trajectory;
}

// Returns where samples of velocity, acceleration or jerk exceed their limits.
std::vector<LimitPeak> Retiming::Peaks(const JointTrajectory& trajectory,
                                       const std::vector<double>& parameters) const {
  std::vector<LimitPeak> peaks;
  for (Eigen::Index i = 1; i + 1 < trajectory.size(); ++i) {
    double ratio = 0.0;
    for (Eigen::Index j = 0; j < trajectory.positions.cols(); ++j) {
      const JointLimits& limit = limits_[static_cast<std::size_t>(j)];
      const auto& acceleration = trajectory.accelerations.col(j);
      const double jerk = options_.rate * (acceleration[i + 1] - acceleration[i]);
      ratio =
          std::max({ratio, std::abs(trajectory.velocities(i, j)) / limit.velocity,
                    std::abs(acceleration[i]) / limit.acceleration, std::abs(jerk) / limit.jerk});
    }
    if (ratio <= 1.0) continue;
    const auto sample = static_cast<std::size_t>(i);
    peaks.push_back({parameters[sample - 1], parameters[sample + 1], ratio});
  }
  return peaks;
}

// Throws an error that names the limit requiring the largest slow-down: velocity falls with the
// slowness, acceleration with its square, jerk with its cube.
void Retiming::FailLimits(const PathDerivatives& derivatives, const RestToRest& ends) const {
  double most = 0.0;
  std::string worst;
  for (Eigen::Index i = 0; i < derivatives.first.cols(); ++i) {
    const double recorded =
        path_.times.front() + ends.At(derivatives.step * static_cast<double>(i))[0];
    for (Eigen::Index j = 0; j < derivatives.first.rows(); ++j) {
      const JointLimits& limit = limits_[static_cast<std::size_t>(j)];
      const auto consider = [&](const char* quantity, double value, double bound, int order) {
        const double slowness = std::pow(std::abs(value) / bound, 1.0 / order);
        if (slowness <= most) return;
        most = slowness;
        worst = "joint '" + path_.joints[static_cast<std::size_t>(j)] + "' at " +
                DisplayText(0.01 * std::round(100.0 * recorded)) + " s needs " + quantity + " " +
                DisplayText(value) + ", the limit is " + DisplayText(bound);
      };
      consider("velocity", derivatives.first(j, i), limit.velocity, 1);
      consider("acceleration", derivatives.second(j, i), limit.acceleration, 2);
      consider("jerk", derivatives.third(j, i), limit.jerk, 3);
    }
  }
  Fail("the motion would take more than " + DisplayText(options_.max_stretch) +
           " times as long as its recording: " + worst,
       "allow more deviation or a longer stretch");
}

// Samples the found law and returns true if the check accepts the motion. Otherwise tightens the
// law where samples between the points of its grid exceed the limits, and tries again.
bool Retiming::Finish(const QuinticSpline& curve, const RestToRest& ends, TimeLawSearch* search,
                      Retimed* result) const {
  for (int i = 0; i < kTightenings; ++i) {
    TimeLaw law = search->law();
    result->stretch = TimeTable(law).duration() / result->recorded;
    if (result->stretch > options_.max_stretch) return false;
    std::vector<double> parameters;
    result->trajectory = Sample(curve, ends, &law, &parameters);
    if (CheckLimits(result->trajectory, limits_).accepted()) {
      const TimeTable table(law);
      result->stretch = table.duration() / result->recorded;
      for (const double u : parameters_) {
        result->waypoint_times.push_back(table.Time(ends.Parameter(u)));
      }
      return true;
    }
    const std::vector<LimitPeak> peaks = Peaks(result->trajectory, parameters);
    if (peaks.empty() || !search->Tighten(peaks)) return false;
  }
  return false;
}

Retimed Retiming::Run() {
  Retimed result;
  const QuinticSpline curve = FitPath(&result);
  const RestToRest ends(curve.length(), options_.ramp);
  const PathDerivatives derivatives = Derivatives(curve, ends);
  result.recorded = parameters_.back();
  TimeLawSearch search(derivatives, ends.length(), limits_, Paces(derivatives, ends));
  double share = kShare;
  for (int i = 0; i < kRefinements; ++i, share *= kLessShare) {
    // If jerk keeps peaking between the grid points, coarser knots are used.
    const bool found = search.Find(share, i / kTriesALevel);
    if (found && Finish(curve, ends, &search, &result)) return result;
    if (!found || result.stretch > options_.max_stretch) FailLimits(derivatives, ends);
  }
  Fail(CheckLimits(result.trajectory, limits_).findings.front().sentence + " after " +
       std::to_string(kRefinements) + " refinements");
}

}  // namespace

bool RetimingOptions::IsValid(std::string* error) const {
  const char* wrong = nullptr;
  if (!(rate >= 10.0 && rate <= 1e4)) wrong = "rate must be in [10, 10000]";
  if (!(revolute_deviation > 0.0 && prismatic_deviation > 0.0 && tool_deviation > 0.0)) {
    wrong = "deviations must be above 0";
  }
  if (!(max_revolute_step > 0.0 && max_prismatic_step > 0.0))
    wrong = "longest steps must be above 0";
  if (!(ramp >= 0.01 && ramp <= 10.0)) wrong = "ramp must be in [0.01, 10]";
  if (!(max_speed_up >= 1.0 && max_speed_up <= 100.0)) wrong = "max_speed_up must be in [1, 100]";
  if (!(max_stretch >= 1.0)) wrong = "max_stretch must be at least 1";
  if (wrong != nullptr && error != nullptr) *error = wrong;
  return wrong == nullptr;
}

Retimed Retime(const RecordedPath& path, const std::vector<JointLimits>& limits,
               const std::vector<bool>& sliding, const Arm* arm, const RetimingOptions& options) {
  std::string wrong;
  if (!options.IsValid(&wrong)) Fail(wrong);
  RequireShape(path, limits, sliding);
  RequireEvenTimes(path);
  RequirePossible(path, limits, sliding, options);
  return Retiming(path, limits, sliding, arm, options).Run();
}

}  // namespace simwright::robot
