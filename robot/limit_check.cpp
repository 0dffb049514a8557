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
  // Considers `values`, each at the mean of the times of the samples i and i + `span`.
  void Consider(const Eigen::VectorXd& values, Eigen::Index span, double limit,
                WorstValue* worst) const {
    Eigen::Index largest = 0;
    double size = -1.0;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (std::abs(values[i]) <= size) continue;
      size = std::abs(values[i]);
      largest = i;
    }
    if (values.size() == 0 || (size / limit <= worst->ratio && worst->limit > 0.0)) return;
    *worst = {values[largest], limit, size / limit, 0.5 * (Time(largest) + Time(largest + span))};
  }
  void Consider(const Eigen::VectorXd& values, double limit, WorstValue* worst) const {
    Consider(values, 0, limit, worst);
  }
  // Returns divided differences times order!, means of the derivative of that order over `order`
  // intervals, from those of the order below.
  Eigen::VectorXd Differences(const Eigen::VectorXd& values, Eigen::Index order) const {
    if (values.size() < 2) return {};
    Eigen::VectorXd differences(values.size() - 1);
    for (Eigen::Index i = 0; i < differences.size(); ++i) {
      differences[i] =
          static_cast<double>(order) * (values[i + 1] - values[i]) / (Time(i + order) - Time(i));
    }
    return differences;
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
  const Eigen::VectorXd from_positions = Differences(positions_, 1);
  const Eigen::VectorXd from_velocities = Differences(velocities_, 1);
  Consider(velocities_, limits_.velocity, &result_.velocity);
  Consider(from_positions, 1, limits_.velocity, &result_.velocity);
  const Eigen::VectorXd second = Differences(from_positions, 2);
  Consider(accelerations_, limits_.acceleration, &result_.acceleration);
  Consider(from_velocities, 1, limits_.acceleration, &result_.acceleration);
  Consider(second, 2, limits_.acceleration, &result_.acceleration);
  result_.jerk.limit = limits_.jerk;
  Consider(Differences(accelerations_, 1), 1, limits_.jerk, &result_.jerk);
  Consider(Differences(from_velocities, 2), 2, limits_.jerk, &result_.jerk);
  Consider(Differences(second, 3), 3, limits_.jerk, &result_.jerk);
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
    const double position_bound = 0.033 * limits_.jerk * h * h * h + rounding;
    const double velocity_bound =
        limits_.jerk * h * h / 4.0 + rounding + 1e-12 * std::abs(velocities_[i]);
    if (position_error > worst_velocity * position_bound) {
      worst_velocity = position_error / position_bound;
      velocity_at = i;
    }
    if (velocity_error > worst_acceleration * velocity_bound) {
      worst_acceleration = velocity_error / velocity_bound;
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
