#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "robot/joint_limits.h"
#include "robot/joint_trajectory.h"

namespace simwright::robot {

// Returns positions at equal steps along the path of `trajectory`, and the step: the path length is
// measured in joint space (1 m of a prismatic joint counts as 20 rad). Rests add no length.
inline Eigen::MatrixXd AlongTheWay(const JointTrajectory& trajectory,
                                   const std::vector<bool>& sliding, int points, double* step) {
  Eigen::RowVectorXd scale(trajectory.positions.cols());
  for (Eigen::Index j = 0; j < scale.size(); ++j) {
    scale[j] = sliding[static_cast<std::size_t>(j)] ? 20.0 : 1.0;
  }
  const Eigen::MatrixXd scaled = trajectory.positions * scale.asDiagonal();
  std::vector<double> gone = {0.0};
  for (Eigen::Index i = 1; i < scaled.rows(); ++i) {
    gone.push_back(gone.back() + (scaled.row(i) - scaled.row(i - 1)).norm());
  }
  *step = gone.back() / (points - 1);
  Eigen::MatrixXd rows(points, scale.size());
  std::size_t at = 0;
  for (int i = 0; i < points; ++i) {
    const double place = std::min(gone.back(), i * *step);
    while (at + 2 < gone.size() && gone[at + 1] < place) ++at;
    const double span = gone[at + 1] - gone[at];
    const double share = span > 0.0 ? std::clamp((place - gone[at]) / span, 0.0, 1.0) : 0.0;
    const auto row = static_cast<Eigen::Index>(at);
    rows.row(i) =
        (1.0 - share) * trajectory.positions.row(row) + share * trajectory.positions.row(row + 1);
  }
  return rows;
}

// Returns the shortest time in s for the path through `rows` (equal steps of `step`) from rest to
// rest within the velocity and acceleration limits, without a jerk limit: derivatives by divided
// differences, speeds by integration backward from the end and forward from the start. Independent
// of splines and time laws.
inline double LeastSeconds(const Eigen::MatrixXd& rows, double step,
                           const std::vector<JointLimits>& limits) {
  const Eigen::Index count = rows.rows(), joints = rows.cols();
  Eigen::MatrixXd first(count, joints), second(count, joints);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index c = std::clamp<Eigen::Index>(i, 1, count - 2);
    first.row(i) = (rows.row(c + 1) - rows.row(c - 1)) / (2.0 * step);
    second.row(i) = (rows.row(c + 1) - 2.0 * rows.row(c) + rows.row(c - 1)) / (step * step);
  }
  // Computes the smallest and largest half growth of the squared speed x along the path.
  const auto growth = [&](Eigen::Index i, double x, double* least, double* largest) {
    *least = -1e9;
    *largest = 1e9;
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double limit = limits[static_cast<std::size_t>(j)].acceleration;
      const double slope = first(i, j), bent = second(i, j) * x;
      if (std::abs(slope) < 1e-9) {
        if (std::abs(bent) > limit) *largest = -1e10;
        continue;
      }
      *least = std::max(*least, std::min((-limit - bent) / slope, (limit - bent) / slope));
      *largest = std::min(*largest, std::max((-limit - bent) / slope, (limit - bent) / slope));
    }
  };
  std::vector<double> most(static_cast<std::size_t>(count), 0.0);
  for (Eigen::Index i = count - 2; i >= 0; --i) {
    const double next = most[static_cast<std::size_t>(i + 1)];
    double low = 0.0, high = 1e8;
    for (Eigen::Index j = 0; j < joints; ++j) {
      const double slope = std::max(1e-9, std::abs(first(i, j)));
      high = std::min(high, std::pow(limits[static_cast<std::size_t>(j)].velocity / slope, 2));
    }
    for (int k = 0; k < 60; ++k) {
      const double x = 0.5 * (low + high);
      double least, largest;
      growth(i, x, &least, &largest);
      const bool can =
          std::max(least, -x / (2.0 * step)) <= std::min(largest, (next - x) / (2.0 * step));
      (can ? low : high) = x;
    }
    most[static_cast<std::size_t>(i)] = low;
  }
  double x = 0.0, seconds = 0.0;
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    double least, largest;
    growth(i, x, &least, &largest);
    const double next =
        std::clamp(x + 2.0 * step * largest, 0.0, most[static_cast<std::size_t>(i + 1)]);
    seconds += 2.0 * step / std::max(1e-9, std::sqrt(x) + std::sqrt(next));
    x = next;
  }
  return seconds;
}

}  // namespace simwright::robot
