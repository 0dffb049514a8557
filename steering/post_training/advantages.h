#pragma once

#include <vector>

namespace simwright::steering {

inline constexpr double kLargestAdvantage = 5.0;  // as published

// Returns the advantages of rewards: their deviations from the mean, divided by the standard
// deviation and clipped to +-kLargestAdvantage. `groups`: rewards i and j are compared only if i %
// groups == j % groups (scenes of one prompt). A group whose rewards are all equal has none.
// Throws core::Error for groups < 1 or a reward that is not finite.
std::vector<double> Advantages(const std::vector<double>& rewards, int groups = 1);

}  // namespace simwright::steering
