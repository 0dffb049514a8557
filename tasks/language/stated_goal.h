#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

namespace simwright::tasks {

// Parses three numbers, "[0.1, 0.2, 0.5]" or "(0.1, 0.2, 0.5) m" (m, world). Returns nullopt if
// there are not exactly three numbers, or if one exceeds 100 m.
std::optional<Eigen::Vector3d> StatedGoal(std::string_view text);

}  // namespace simwright::tasks
