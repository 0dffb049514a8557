#include "robot/joint_trajectory.h"

#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.h"

namespace simwright::robot {
namespace {

std::string Shown(double time) {
  std::ostringstream text;
  text << time;
  return text.str();
}

}  // namespace

void RequireWellFormed(const JointTrajectory& trajectory, const std::string& where) {
  const auto count = static_cast<Eigen::Index>(trajectory.joints.size());
  if (count == 0 || trajectory.size() == 0) {
    throw core::Error("the trajectory has no joints or no samples", where);
  }
  std::set<std::string> names;
  for (const std::string& name : trajectory.joints) {
    if (name.empty()) throw core::Error("a joint has no name", where);
    if (!names.insert(name).second) throw core::Error("two joints are named '" + name + "'", where);
  }
  const std::pair<const char*, const Eigen::MatrixXd*> matrices[] = {
      {"positions", &trajectory.positions},
      {"velocities", &trajectory.velocities},
      {"accelerations", &trajectory.accelerations},
      {"efforts", &trajectory.efforts}};
  for (const auto& [name, matrix] : matrices) {
    if (matrix->size() == 0 && matrix != &trajectory.positions) continue;
    if (matrix->rows() == trajectory.size() && matrix->cols() == count) continue;
    throw core::Error("there are " + std::to_string(matrix->rows()) + " x " +
                          std::to_string(matrix->cols()) + " " + name + " for " +
                          std::to_string(trajectory.size()) + " times and " +
                          std::to_string(count) + " joints",
                      where);
  }
  for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
    const double time = trajectory.times[static_cast<std::size_t>(i)];
    const double before = i == 0 ? -1e-300 : trajectory.times[static_cast<std::size_t>(i - 1)];
    if (!std::isfinite(time) || time < 0.0 || !(time > before)) {
      throw core::Error("the time of sample " + std::to_string(i) + ", " + Shown(time) +
                            " s, does not exceed the previous one",
                        where, "give finite, increasing times");
    }
  }
  for (const auto& [name, matrix] : matrices) {
    if (matrix->allFinite()) continue;
    for (Eigen::Index i = 0; i < matrix->rows(); ++i) {
      const double time = trajectory.times[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < matrix->cols(); ++j) {
        if (std::isfinite((*matrix)(i, j))) continue;
        throw core::Error(std::string("one of the ") + name + " is not finite",
                          where + " joint '" + trajectory.joints[static_cast<std::size_t>(j)] +
                              "' at " + Shown(time) + " s");
      }
    }
  }
}

}  // namespace simwright::robot
