#include "sim/body_experiments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/progress.h"
#include "sim/max_displacement.h"

namespace simwright::sim {
namespace {

constexpr double kGravity = 9.81;     // m/s^2
constexpr double kStackSettle = 0.5;  // s

// Steps until `time` (s), counting steps: MuJoCo resets its clock when a world diverges.
void StepUntil(double time, double* now, BodyRig* rig) {
  for (; *now < time - 0.5 * rig->time_step(); *now += rig->time_step()) rig->Step();
  core::CheckCancelled();
}

double CheckedDisplacement(const Eigen::Vector3d& center, double radius,
                           const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const double displacement = MaxDisplacement(center, radius, from, to);
  return std::isfinite(displacement) ? displacement : HUGE_VAL;
}

}  // namespace

bool SlopeOptions::IsValid(std::string* error) const {
  if (!(angle >= 0.0 && angle < 0.5 * std::numbers::pi)) {
    *error = "the angle of a slope must be at least 0 and below 90 degrees";
  } else if (!std::isfinite(direction)) {
    *error = "the direction of a slope must be finite";
  } else if (!(settle >= 0.0 && tilt_time > 0.0 && watch > 0.0 && settle + watch < 3600.0)) {
    *error = "the times of a slope must be positive and below an hour";
  } else {
    return true;
  }
  return false;
}

DropResult DropBody(const RigidBody& body, const DropOptions& options, const BodyRigFactory& rigs) {
  const Eigen::Isometry3d start = StartPose(body, options);
  const auto rig = rigs(start, {});
  DropObserver observer(body, options, start);
  const double end = options.settle_time + options.drift_time;
  for (double now = 0.0; now < end - 1e-9;) {
    rig->Step();
    now += rig->time_step();
    observer.Observe(now, rig->Pose(0));
  }
  core::CheckCancelled();
  return observer.Finish();
}

SlopeResult StandOnSlope(const RigidBody& body, const Eigen::Isometry3d& world_from_body,
                         const SlopeOptions& options, const BodyRigFactory& rigs) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("slope: " + error, body.name);
  const auto rig = rigs(world_from_body, {});
  const Eigen::Vector3d downhill(std::cos(options.direction), std::sin(options.direction), 0.0);
  double now = 0.0;
  StepUntil(options.settle, &now, rig.get());
  for (double end = options.settle + options.tilt_time; now < end; now += rig->time_step()) {
    const double share = std::min(1.0, (now - options.settle) / options.tilt_time);
    const double angle = options.angle * share;
    rig->SetGravity(kGravity *
                    (std::sin(angle) * downhill - std::cos(angle) * Eigen::Vector3d::UnitZ()));
    rig->Step();
  }
  rig->SetGravity(kGravity * (std::sin(options.angle) * downhill -
                              std::cos(options.angle) * Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d& center = body.inertial.center_of_mass;
  const Eigen::Isometry3d begin = rig->Pose(0);
  const double start = now;
  StepUntil(start + 0.5 * options.watch, &now, rig.get());
  const double first = now - start;
  const Eigen::Isometry3d middle = rig->Pose(0);
  StepUntil(start + options.watch, &now, rig.get());
  const double second = now - start - first;
  const Eigen::Isometry3d end = rig->Pose(0);
  const double first_speed = downhill.dot(middle * center - begin * center) / first;
  const double second_speed = downhill.dot(end * center - middle * center) / second;
  SlopeResult result;
  result.displacement = CheckedDisplacement(center, Radius(body), begin, end);
  result.acceleration = (second_speed - first_speed) / (0.5 * (first + second));
  result.tilt = TiltBetween(begin, end);
  return result;
}

StackResult StandInStack(const RigidBody& body, const Eigen::Isometry3d& world_from_body,
                         const std::vector<RigBox>& boxes, double watch,
                         const BodyRigFactory& rigs) {
  const auto rig = rigs(world_from_body, boxes);
  const auto poses = [&] {
    std::vector<Eigen::Isometry3d> all;
    for (int i = 0; i <= static_cast<int>(boxes.size()); ++i) all.push_back(rig->Pose(i));
    return all;
  };
  const auto displacements = [&](const std::vector<Eigen::Isometry3d>& from) {
    std::vector<double> all;
    for (size_t i = 0; i < from.size(); ++i) {
      const Eigen::Vector3d center =
          i == 0 ? body.inertial.center_of_mass : Eigen::Vector3d::Zero();
      const double radius = i == 0 ? Radius(body) : 0.5 * boxes[i - 1].size.norm();
      all.push_back(CheckedDisplacement(center, radius, from[i], rig->Pose(static_cast<int>(i))));
    }
    return all;
  };
  const std::vector<Eigen::Isometry3d> placed = poses();
  double now = 0.0;
  StepUntil(kStackSettle, &now, rig.get());
  StackResult result;
  const std::vector<double> settling = displacements(placed);
  result.settling = *std::max_element(settling.begin(), settling.end());
  const std::vector<Eigen::Isometry3d> settled = poses();
  StepUntil(kStackSettle + watch, &now, rig.get());
  result.displacements = displacements(settled);
  result.penetration = rig->DeepestPenetration();
  return result;
}

}  // namespace simwright::sim
