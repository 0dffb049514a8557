#include "tests/rl/reach_environment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/error.h"

namespace simwright::rl {

ReachEnvironment::ReachEnvironment(int count, int episode_steps)
    : episode_steps_(episode_steps), points_(static_cast<std::size_t>(count)) {}

ReachEnvironment::Point ReachEnvironment::SampleStart() {
  return {core::Uniform(rng_, -1.0, 1.0), core::Uniform(rng_, -0.5, 0.5), 0};
}

void ReachEnvironment::Observe(Rows* observations) const {
  observations->resize(size(), 2);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    observations->row(static_cast<Eigen::Index>(i)) << static_cast<float>(points_[i].x),
        static_cast<float>(points_[i].v);
  }
}

void ReachEnvironment::Reset(std::uint64_t seed, Rows* observations) {
  rng_ = core::StreamRng(seed, 0);
  for (Point& point : points_) {
    point = SampleStart();
    // The time limits must not coincide.
    point.steps = static_cast<int>(core::UniformIndex(rng_, episode_steps_));
  }
  Observe(observations);
}

void ReachEnvironment::Step(const Rows& actions, StepBatch* batch) {
  batch->rewards.resize(points_.size());
  batch->terminated.assign(points_.size(), 0);
  batch->truncated.assign(points_.size(), 0);
  batch->success.assign(points_.size(), 0);
  batch->last_observations.resize(size(), 2);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& point = points_[i];
    const auto row = static_cast<Eigen::Index>(i);
    const double u = kPush * std::clamp(static_cast<double>(actions(row, 0)), -1.0, 1.0);
    const double cost = point.x * point.x + kSpeedCost * point.v * point.v + kPushCost * u * u;
    batch->rewards[i] = static_cast<float>(-cost);
    point.x += kTimeStep * point.v;
    point.v += kTimeStep * u;
    ++point.steps;
    batch->terminated[i] = std::abs(point.x) > 3.0;
    batch->truncated[i] = !batch->terminated[i] && point.steps >= episode_steps_;
    if (batch->terminated[i]) batch->rewards[i] -= static_cast<float>(kLeavingCost);
    if (!batch->terminated[i] && !batch->truncated[i]) continue;
    batch->success[i] = std::abs(point.x) < 0.05;
    batch->last_observations.row(row) << static_cast<float>(point.x), static_cast<float>(point.v);
    point = SampleStart();
  }
  if (spoilt_ >= 0) {
    batch->rewards[static_cast<std::size_t>(spoilt_)] = std::numeric_limits<float>::quiet_NaN();
  }
  spoilt_ = -1;
  Observe(&batch->observations);
}

std::string ReachEnvironment::SaveState() const {
  std::ostringstream out;
  out.precision(17);
  out << points_.size() << ' ' << rng_;
  for (const Point& point : points_) out << ' ' << point.x << ' ' << point.v << ' ' << point.steps;
  return out.str();
}

void ReachEnvironment::RestoreState(std::string_view state, Rows* observations) {
  std::istringstream in{std::string(state)};
  std::size_t count = 0;
  if (!(in >> count) || count != points_.size()) throw core::Error("a state of other environments");
  in >> rng_;
  for (Point& point : points_) in >> point.x >> point.v >> point.steps;
  if (!in) throw core::Error("a damaged state");
  Observe(observations);
}

}  // namespace simwright::rl
