#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

namespace simwright::tasks {

// Three numbers, "[0.1, 0.2, 0.5]" or "(0.1, 0.2, 0.5) m": m, world. Unset where there are not
// exactly three, or one lies beyond 100 m.
std::optional<Eigen::Vector3d> StatedGoal(std::string_view text);

}  // namespace simwright::tasks
