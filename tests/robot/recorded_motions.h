#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/random.h"
#include "robot/retiming.h"
#include "robot/robot_model.h"

namespace simwright::robot {

// The inputs of retiming for a robot's arm and gripper.
struct RetimedJoints {
  std::vector<std::string> names;
  std::vector<JointLimits> limits;  // of commands
  std::vector<bool> sliding;
};

inline RetimedJoints JointsToRetime(const RobotModel& model) {
  RetimedJoints joints;
  std::vector<int> indices = model.arm_joints;
  indices.insert(indices.end(), model.gripper.joints.begin(), model.gripper.joints.end());
  for (const int index : indices) {
    const auto i = static_cast<std::size_t>(index);
    joints.names.push_back(model.urdf.joints[i].name);
    joints.limits.push_back(CommandLimits(model.limits[i], model.margin));
    joints.sliding.push_back(model.urdf.joints[i].type == assets::JointType::kPrismatic);
  }
  return joints;
}

// Motions as recorded by a simulation at 60 Hz: of the arm, of the given `kind`, and of fingers
// that close at full speed, hold, and open again.
enum class MotionKind {
  kSmooth,   // sines at up to half the velocity limits
  kFast,     // the same at up to three times the limits
  kPolicy,   // a new velocity per step, up to 0.8 of the limits, with a lag of 50 ms
  kNoisy,    // smooth, with position noise of up to 0.5 mrad or 0.1 mm
  kCorners,  // straight lines at up to 0.8 of the velocity limits, with sudden turns
};

inline RecordedPath MakeMotion(const RobotModel& model, MotionKind kind, double seconds,
                               std::uint64_t seed) {
  const RetimedJoints joints = JointsToRetime(model);
  core::Rng rng(seed);
  RecordedPath path;
  path.joints = joints.names;
  const auto count = static_cast<Eigen::Index>(seconds * 60.0) + 1;
  for (Eigen::Index k = 0; k < count; ++k) path.times.push_back(static_cast<double>(k) / 60.0);
  path.positions.resize(count, static_cast<Eigen::Index>(joints.names.size()));
  for (int j = 0; j < model.arm.size(); ++j) {
    const JointLimits& limit = joints.limits[static_cast<std::size_t>(j)];
    const double middle = 0.5 * (limit.lower + limit.upper);
    const double room = 0.45 * (limit.upper - limit.lower);
    const double fastest = limit.velocity * (kind == MotionKind::kFast ? 3.0 : 0.5);
    const double frequency = core::Uniform(rng, 0.5, 3.0);  // rad/s
    const double size = std::min(room, fastest / frequency), phase = core::Uniform(rng, 0.0, 6.28);
    double q = middle, velocity = 0.0, wanted = 0.0;
    for (Eigen::Index k = 0; k < count; ++k) {
      double& value = path.positions(k, j);
      value = middle + size * std::sin(frequency * path.times[static_cast<std::size_t>(k)] + phase);
      if (kind == MotionKind::kNoisy) {
        value += (limit.upper > 1.5 ? 5e-4 : 1e-4) * core::Uniform(rng, -1.0, 1.0);
      }
      if (kind != MotionKind::kPolicy && kind != MotionKind::kCorners) continue;
      if (kind == MotionKind::kPolicy || k % 20 == 0) {
        wanted = limit.velocity * core::Uniform(rng, -0.8, 0.8);
      }
      // Reverses in time: in a third of a second it moves 0.7 rad at most.
      if (std::abs(q - middle) > 0.5 * room) {
        wanted = std::copysign(wanted, middle - q);
      }
      velocity = kind == MotionKind::kPolicy ? velocity + (wanted - velocity) / 3.0 : wanted;
      value = q;
      q += velocity / 60.0;
    }
  }
  for (std::size_t f = 0; f < model.gripper.joints.size(); ++f) {
    const double open = model.gripper.open, held = 0.4 * open;
    const double speed =
        model.limits[static_cast<std::size_t>(model.gripper.joints[f])].velocity / 60.0;
    double q = open;
    for (Eigen::Index k = 0; k < count; ++k) {
      path.positions(k, model.arm.size() + static_cast<Eigen::Index>(f)) = q;
      const double goal = k > count / 4 && k < 3 * count / 4 ? held : open;
      q += std::clamp(goal - q, -speed, speed);
    }
  }
  return path;
}

// Returns a lower bound on the duration of a motion along `path` within the velocity limits,
// relative to the recording.
inline double LeastStretch(const RecordedPath& path, const std::vector<JointLimits>& limits) {
  double least = 0.0;
  for (Eigen::Index k = 1; k < path.positions.rows(); ++k) {
    double seconds =
        path.times[static_cast<std::size_t>(k)] - path.times[static_cast<std::size_t>(k - 1)];
    for (Eigen::Index j = 0; j < path.positions.cols(); ++j) {
      const double way = std::abs(path.positions(k, j) - path.positions(k - 1, j));
      seconds = std::max(seconds, way / limits[static_cast<std::size_t>(j)].velocity);
    }
    least += seconds;
  }
  return least / (path.times.back() - path.times.front());
}

}  // namespace simwright::robot
