#include "robot/limit_check.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "robot/number_text.h"

namespace simwright::robot {
namespace {

constexpr double kRounding = 1e-9;  // relative tolerance for values at the limit
constexpr double kRest = 1e-6;      // per s, s^2

// The samples of one joint, and its findings.
class JointCheck {
 public:
  JointCheck(const JointTrajectory& trajectory, Eigen::Index joint, const JointLimits& limits,
             LimitReport* report)
      : times_(trajectory.times),
        positions_(trajectory.positions.col(joint)),
        velocities_(trajectory.velocities.col(joint)),
        accelerations_(trajectory.accelerations.col(joint)),
        limits_(limits),
        report_(report) {
    result_.joint = trajectory.joints[static_cast<std::size_t>(joint)];
    if (trajectory.efforts.size() > 0) efforts_ = trajectory.efforts.col(joint);
  }

  JointLimitReport Run() {
    CheckPositions();
    CheckRates();
    CheckAgreement();
    CheckRest();
    if (efforts_.size() > 0 && limits_.effort > 0.0) {
      Consider(efforts_, limits_.effort, &result_.effort);
      Report("limit-effort", "effort", result_.effort);
    }
    return result_;
  }

 private:
  double Time(Eigen::Index i) const { return times_[static_cast<std::size_t>(i)]; }

  void Add(const std::string& code, double time, const std::string& sentence, double figure) {
    report_->findings.push_back({code, core::Severity::kError,
                                 "joint '" + result_.joint + "' at " + DisplayText(time) + " s",
                                 sentence, figure});
  }
  void Report(const std::string& code, const std::string& quantity, const WorstValue& worst) {
    if (worst.ratio <= 1.0 + kRounding) return;
    Add(code, worst.time,
        "its " + quantity + " is " + DisplayText(worst.value) + ", the limit " +
            DisplayText(worst.limit),
        worst.value);
  }
  static void Consider(double value, double time, double limit, WorstValue* worst) {
    const double ratio = std::abs(value) / limit;
    if (ratio <= worst->ratio && worst->limit > 0.0) return;
    *worst = {value, limit, ratio, time};
  }
  void Consider(const Eigen::VectorXd& values, double limit, WorstValue* worst) const {
    for (Eigen::Index i = 0; i < values.size(); ++i) Consider(values[i], Time(i), limit, worst);
  }
  // Checks divided differences of `values` times order!: means of the derivative of that order over
  // `order` intervals.
  void ConsiderDifferences(Eigen::VectorXd values, int order, double limit,
                           WorstValue* worst) const {
    for (int k = 1; k <= order; ++k) {
      for (Eigen::Index i = 0; i + k < positions_.size(); ++i) {
        values[i] = k * (values[i + 1] - values[i]) / (Time(i + k) - Time(i));
      }
    }
    for (Eigen::Index i = 0; i + order < positions_.size(); ++i) {
      Consider(values[i], 0.5 * (Time(i) + Time(i + order)), limit, worst);
    }
  }

  void CheckPositions();
  void CheckRates();
  void CheckAgreement();
  void CheckRest();

  const std::vector<double>& times_;
  Eigen::VectorXd positions_, velocities_, accelerations_, efforts_;
  JointLimits limits_;
  LimitReport* report_;
  JointLimitReport result_;
};

void JointCheck::CheckPositions() {
  const double middle = 0.5 * (limits_.lower + limits_.upper);
  const double half = 0.5 * (limits_.upper - limits_.lower);
  result_.position.limit = limits_.upper;
  result_.position.value = positions_[0];
  for (Eigen::Index i = 0; i < positions_.size(); ++i) {
    const double ratio = std::abs(positions_[i] - middle) / half;
    if (ratio <= result_.position.ratio) continue;
    const double bound = positions_[i] < middle ? limits_.lower : limits_.upper;
    result_.position = {positions_[i], bound, ratio, Time(i)};
  }
  Report("limit-position", "position", result_.position);
}

void JointCheck::CheckRates() {
  Consider(velocities_, limits_.velocity, &result_.velocity);
  ConsiderDifferences(positions_, 1, limits_.velocity, &result_.velocity);
  Consider(accelerations_, limits_.acceleration, &result_.acceleration);
  ConsiderDifferences(velocities_, 1, limits_.acceleration, &result_.acceleration);
  ConsiderDifferences(positions_, 2, limits_.acceleration, &result_.acceleration);
  result_.jerk.limit = limits_.jerk;
  ConsiderDifferences(accelerations_, 1, limits_.jerk, &result_.jerk);
  ConsiderDifferences(velocities_, 2, limits_.jerk, &result_.jerk);
  ConsiderDifferences(positions_, 3, limits_.jerk, &result_.jerk);
  Report("limit-velocity", "velocity", result_.velocity);
  Report("limit-acceleration", "acceleration", result_.acceleration);
  Report("limit-jerk", "jerk", result_.jerk);
}

// Over a step of h, a motion whose jerk stays within J changes its velocity by the trapezoid of its
// accelerations, to within J h^2 / 4, and its position by the trapezoid of its velocities,
// corrected by the difference of the accelerations (Euler-Maclaurin), to within J h^3 times the
// mean of |B_2| / 2, 0.0321.
void JointCheck::CheckAgreement() {
  double worst_velocity = 1.0, worst_acceleration = 1.0;
  Eigen::Index velocity_at = -1, acceleration_at = -1;
  for (Eigen::Index i = 0; i + 1 < positions_.size(); ++i) {
    const double h = Time(i + 1) - Time(i);
    const double position_change = positions_[i + 1] - positions_[i];
    const double velocity_change = velocities_[i + 1] - velocities_[i];
    const double position_error =
        std::abs(position_change - 0.5 * h * (velocities_[i] + velocities_[i + 1]) +
                 h * h / 12.0 * (accelerations_[i + 1] - accelerations_[i]));
    const double velocity_error =
        std::abs(velocity_change - 0.5 * h * (accelerations_[i] + accelerations_[i + 1]));
    const double rounding = 1e-12 * (1.0 + std::abs(positions_[i]));
    const double position_ratio = position_error / (0.033 * limits_.jerk * h * h * h + rounding);
    const double velocity_ratio =
        velocity_error / (limits_.jerk * h * h / 4.0 + rounding + 1e-12 * std::abs(velocities_[i]));
    if (position_ratio > worst_velocity) {
      worst_velocity = position_ratio;
      velocity_at = i;
    }
    if (velocity_ratio > worst_acceleration) {
      worst_acceleration = velocity_ratio;
      acceleration_at = i;
    }
  }
  if (velocity_at >= 0) {
    Add("velocity-mismatch", Time(velocity_at),
        "the given velocities are not the derivatives of the positions", worst_velocity);
  }
  if (acceleration_at >= 0) {
    Add("acceleration-mismatch", Time(acceleration_at),
        "the given accelerations are not the derivatives of the velocities", worst_acceleration);
  }
}

void JointCheck::CheckRest() {
  for (const Eigen::Index i : {Eigen::Index(0), positions_.size() - 1}) {
    if (std::abs(velocities_[i]) <= kRest && std::abs(accelerations_[i]) <= kRest) continue;
    Add("no-rest", Time(i),
        "it is not at rest at an end of the trajectory: velocity " + DisplayText(velocities_[i]) +
            ", acceleration " + DisplayText(accelerations_[i]),
        velocities_[i]);
  }
}

}  // namespace

LimitReport CheckLimits(const JointTrajectory& trajectory, const std::vector<JointLimits>& limits) {
  RequireWellFormed(trajectory, "limit check");
  if (trajectory.velocities.size() == 0 || trajectory.accelerations.size() == 0) {
    throw core::Error("the trajectory has no velocities or no accelerations", "limit check",
                      "retime it first");
  }
  if (limits.size() != trajectory.joints.size()) {
    throw core::Error("there are " + std::to_string(limits.size()) + " limits for " +
                          std::to_string(trajectory.joints.size()) + " joints",
                      "limit check");
  }
  LimitReport report;
  for (std::size_t j = 0; j < limits.size(); ++j) {
    report.joints.push_back(
        JointCheck(trajectory, static_cast<Eigen::Index>(j), limits[j], &report).Run());
  }
  return report;
}

}  // namespace simwright::robot
