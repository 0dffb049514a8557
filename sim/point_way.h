#pragma once

#include <Eigen/Geometry>

namespace simwright::sim {

// m that any point of a body, no farther than `radius` from its centre of mass, has moved by from
// one pose (world_from_body) to another; an upper bound. `center` in the body's frame.
double FarthestWay(const Eigen::Vector3d& center, double radius, const Eigen::Isometry3d& from,
                   const Eigen::Isometry3d& to);

}  // namespace simwright::sim
