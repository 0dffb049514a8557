#pragma once

#include <Eigen/Geometry>

namespace simwright::sim {

// Returns an upper bound (m) of the displacement of any point of a body, no farther than `radius`
// from its centre of mass, between two poses (world_from_body). `center` in the body's frame.
double MaxDisplacement(const Eigen::Vector3d& center, double radius, const Eigen::Isometry3d& from,
                       const Eigen::Isometry3d& to);

}  // namespace simwright::sim
