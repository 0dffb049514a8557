#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::scene {

struct Assignment {
  std::vector<int> column;  // of each row; -1: unassigned
  double cost = 0.0;        // the sum over pairs
};

// Returns the cheapest assignment of min(rows, columns) pairs, with no row or column in two of
// them: the Hungarian method with shortest augmenting paths (Kuhn 1955; Jonker and Volgenant 1987),
// cubic. Costs may be negative. Throws core::Error for costs that are not finite.
Assignment CheapestAssignment(const Eigen::MatrixXd& cost);

}  // namespace simwright::scene
