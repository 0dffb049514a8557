#include "tasks/language/stated_goal.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace simwright::tasks {

std::optional<Eigen::Vector3d> StatedGoal(std::string_view text) {
  constexpr double kFarthest = 100.0;  // m; farther than any robot's workspace
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double number = 0.0;
    const auto [next, error] = std::from_chars(at, end, number, std::chars_format::fixed);
    if (error != std::errc()) {
      ++at;
      continue;
    }
    if (!(std::abs(number) <= kFarthest)) return std::nullopt;
    numbers.push_back(number);
    at = next;
  }
  if (numbers.size() != 3) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

}  // namespace simwright::tasks
