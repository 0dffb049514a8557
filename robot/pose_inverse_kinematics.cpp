#include "robot/pose_inverse_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/error.h"

namespace simwright::robot {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// The damping of the null-space projection: far below the damping of the step, and so is the tool
// motion that it leaks.
constexpr double kProjectionDamping = 1e-9;  // m^2
// m: tool error above which no joint drifts home.
constexpr double kErrorWithoutDrift = 0.05;
// A start is abandoned if this many iterations did not reduce the squared error by this share.
constexpr int kPatience = 5;
constexpr double kLeastGain = 0.3;

// Returns the rotation vector (axis times angle) from `from` to `to`, in their common frame.
Eigen::Vector3d RotationVectorBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::Matrix3d turn = to * from.transpose();
  const Eigen::Vector3d twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                                   turn(1, 0) - turn(0, 1));
  const double sine = 0.5 * twice_sine.norm(), cosine = 0.5 * (turn.trace() - 1.0);
  if (sine > 1e-4) return twice_sine * (0.5 * std::atan2(sine, cosine) / sine);
  if (cosine > 0.0) return 0.5 * twice_sine;  // sine and angle agree to 2e-9, relative
  const Eigen::AngleAxisd half_turn(turn);    // near 180 degrees the sine is ill-conditioned
  return half_turn.angle() * half_turn.axis();
}

}  // namespace

struct PoseInverseKinematics::Target {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position;
};

// The data of one iteration at a configuration.
struct PoseInverseKinematics::Work {
  ToolJacobian jacobian;  // (6 x J), angular rows times the angle weight
  Vector6 vector;         // m, the error, weighted in the same manner
  PoseError error;
  JointVector step;

  double squared() const { return vector.squaredNorm(); }
};

bool PoseInverseKinematicsOptions::IsValid(std::string* error) const {
  const char* wrong = nullptr;
  if (!(position_tolerance > 0.0)) wrong = "position_tolerance must be above 0";
  if (!(angle_tolerance > 0.0)) wrong = "angle_tolerance must be above 0";
  if (!(angle_weight > 0.0)) wrong = "angle_weight must be above 0";
  if (!(min_damping > 0.0)) wrong = "min_damping must be above 0";
  if (!(longest_step > 0.0)) wrong = "longest_step must be above 0";
  if (iterations < 1 || starts < 1 || samples_per_start < 1 || tracking_iterations < 1) {
    wrong = "iterations, starts, samples_per_start and tracking_iterations must be at least 1";
  }
  if (!(rest_gain >= 0.0 && rest_gain <= 1.0)) wrong = "rest_gain must be in [0, 1]";
  if (wrong != nullptr && error != nullptr) *error = wrong;
  return wrong == nullptr;
}

PoseInverseKinematics::PoseInverseKinematics(const Arm& arm,
                                             const PoseInverseKinematicsOptions& options)
    : options_(options), chain_(arm), lower_(arm.size()), upper_(arm.size()) {
  std::string wrong;
  if (!options.IsValid(&wrong)) throw core::Error(wrong, "inverse kinematics");
  if (arm.ready.size() != arm.size()) {
    throw core::Error("the arm has no ready configuration", arm.name);
  }
  home_ = arm.ready;
  for (int j = 0; j < arm.size(); ++j) {
    lower_[j] = arm.joints[static_cast<std::size_t>(j)].lower;
    upper_[j] = arm.joints[static_cast<std::size_t>(j)].upper;
  }
}

void PoseInverseKinematics::Clamp(JointVector* q) const {
  *q = q->cwiseMax(lower_).cwiseMin(upper_);
}

bool PoseInverseKinematics::Reached(const PoseError& error) const {
  return error.position <= options_.position_tolerance && error.angle <= options_.angle_tolerance;
}

void PoseInverseKinematics::Evaluate(const Target& target, const JointVector& q, Work* work) const {
  const Eigen::Isometry3d tool = chain_.Tool(q, &work->jacobian);
  work->jacobian.bottomRows<3>() *= options_.angle_weight;
  work->vector.head<3>() = target.position - tool.translation();
  const Eigen::Vector3d turn = RotationVectorBetween(tool.linear(), target.rotation);
  work->vector.tail<3>() = options_.angle_weight * turn;
  work->error = {work->vector.head<3>().norm(), turn.norm()};
}

// Computes the damped step from `q`: a joint that would leave its limits is fixed, and the others
// are solved again.
void PoseInverseKinematics::Step(const JointVector& q, const JointVector& rest, double rest_gain,
                                 Work* work) const {
  const double damping = 0.5 * work->squared() + options_.min_damping;
  const int count = chain_.size();
  std::array<bool, kMostJoints> fixed{};
  const auto normal = [&](double diagonal) {
    Matrix6 matrix = Matrix6::Identity() * diagonal;
    for (int j = 0; j < count; ++j) {
      if (fixed[static_cast<std::size_t>(j)]) continue;
      const Vector6 column = work->jacobian.col(j);
      matrix.noalias() += column * column.transpose();
    }
    return matrix;
  };
  for (int round = 0; round <= count; ++round) {
    const Vector6 pull = normal(damping).llt().solve(work->vector);
    bool again = false;
    for (int j = 0; j < count; ++j) {
      double& step = work->step[j];
      step = fixed[static_cast<std::size_t>(j)] ? 0.0 : work->jacobian.col(j).dot(pull);
      const bool blocked = (q[j] <= lower_[j] && step < 0.0) || (q[j] >= upper_[j] && step > 0.0);
      if (!blocked) continue;
      fixed[static_cast<std::size_t>(j)] = true;
      again = true;
    }
    if (!again) break;
  }
  if (rest_gain <= 0.0) return;
  // The displacement to rest, minus its component that moves the tool.
  JointVector drift = rest_gain * (rest - q);
  Vector6 tool_motion = Vector6::Zero();
  for (int j = 0; j < count; ++j) {
    if (fixed[static_cast<std::size_t>(j)]) drift[j] = 0.0;
    tool_motion += work->jacobian.col(j) * drift[j];
  }
  const Vector6 back = normal(kProjectionDamping).ldlt().solve(tool_motion);
  for (int j = 0; j < count; ++j) {
    if (fixed[static_cast<std::size_t>(j)]) continue;
    work->step[j] += drift[j] - work->jacobian.col(j).dot(back);
  }
}

PoseError PoseInverseKinematics::Track(const Eigen::Isometry3d& base_from_tool,
                                       const JointVector& longest_step, JointVector* q,
                                       const JointVector* rest) const {
  const Target target{base_from_tool.linear(), base_from_tool.translation()};
  Clamp(q);
  const JointVector before = *q;
  Work work;
  work.step.resize(chain_.size());
  for (int i = 0; i < options_.tracking_iterations; ++i) {
    Evaluate(target, *q, &work);
    const double near = 1.0 - std::sqrt(work.squared()) / kErrorWithoutDrift;
    // Only the first iteration of a call drifts.
    Step(*q, rest ? *rest : home_, i == 0 ? options_.rest_gain * std::max(0.0, near) : 0.0, &work);
    const double largest = work.step.cwiseAbs().maxCoeff();
    if (largest > options_.longest_step) work.step *= options_.longest_step / largest;
    *q += work.step;
    Clamp(q);
  }
  const JointVector displacement = *q - before;
  const double ratio = (displacement.cwiseAbs().cwiseQuotient(longest_step)).maxCoeff();
  if (ratio > 1.0) {
    *q = before + displacement / ratio;
    Clamp(q);
  }
  const Eigen::Isometry3d tool = chain_.Tool(*q);
  return {(target.position - tool.translation()).norm(),
          RotationVectorBetween(tool.linear(), target.rotation).norm()};
}

PoseError PoseInverseKinematics::ErrorAt(const Eigen::Isometry3d& base_from_tool,
                                         const JointVector& q) const {
  const Eigen::Isometry3d tool = chain_.Tool(q);
  return {(base_from_tool.translation() - tool.translation()).norm(),
          RotationVectorBetween(tool.linear(), base_from_tool.linear()).norm()};
}

// Iterates from solution->q until the target is reached or progress stalls.
void PoseInverseKinematics::Descend(const Target& target, PoseSolution* solution) const {
  JointVector& q = solution->q;
  Work work;
  work.step.resize(chain_.size());
  std::array<double, kPatience> earlier;
  earlier.fill(std::numeric_limits<double>::infinity());
  for (int i = 0;; ++i) {
    Evaluate(target, q, &work);
    solution->error = work.error;
    solution->reached = Reached(work.error);
    if (solution->reached || i == options_.iterations) return;
    double& then = earlier[static_cast<std::size_t>(i % kPatience)];
    if (work.squared() > (1.0 - kLeastGain) * then) return;
    then = work.squared();
    Step(q, home_, 0.0, &work);
    const double largest = work.step.cwiseAbs().maxCoeff();
    if (largest > options_.longest_step) work.step *= options_.longest_step / largest;
    q += work.step;
    Clamp(&q);
    ++solution->iterations;
  }
}

// Samples a few random configurations and returns the one whose tool is nearest to the target:
// evaluation is cheaper than iteration.
JointVector PoseInverseKinematics::SampleStart(const Target& target, core::Rng& rng) const {
  JointVector best(chain_.size()), draft(chain_.size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options_.samples_per_start; ++i) {
    for (int j = 0; j < chain_.size(); ++j) {
      draft[j] = core::Uniform(rng, lower_[j], upper_[j]);
    }
    const Eigen::Isometry3d tool = chain_.Tool(draft);
    const double cost = (target.position - tool.translation()).squaredNorm() +
                        std::pow(options_.angle_weight, 2) *
                            RotationVectorBetween(tool.linear(), target.rotation).squaredNorm();
    if (cost >= least) continue;
    least = cost;
    best = draft;
  }
  return best;
}

PoseSolution PoseInverseKinematics::Solve(const Eigen::Isometry3d& base_from_tool,
                                          const JointVector& start, core::Rng& rng) const {
  if (!base_from_tool.matrix().allFinite() || !start.allFinite()) {
    throw core::Error("the target or the start is not finite", "inverse kinematics");
  }
  if (start.size() != chain_.size()) {
    throw core::Error("got " + std::to_string(start.size()) + " joint positions, the arm has " +
                          std::to_string(chain_.size()) + " joints",
                      "inverse kinematics");
  }
  const Target target{base_from_tool.linear(), base_from_tool.translation()};
  PoseSolution best;
  double least = std::numeric_limits<double>::infinity();
  int iterations = 0;
  for (int i = 0; i < options_.starts && !best.reached; ++i) {
    PoseSolution attempt;
    attempt.q = i == 0 ? start : SampleStart(target, rng);
    Clamp(&attempt.q);
    Descend(target, &attempt);
    iterations += attempt.iterations;
    const double cost = attempt.error.position + options_.angle_weight * attempt.error.angle;
    if (attempt.reached || cost < least) {
      least = cost;
      best = attempt;
    }
    best.starts = i + 1;
  }
  best.iterations = iterations;
  return best;
}

}  // namespace simwright::robot
