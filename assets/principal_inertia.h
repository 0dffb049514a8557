#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::assets {

// An inertia as moments about its principal axes.
struct PrincipalInertia {
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  // kg m^2, ascending
  Eigen::Quaterniond link_from_axes = Eigen::Quaterniond::Identity();
};

// Diagonalises a symmetric inertia (kg m^2). Requires finite entries.
PrincipalInertia PrincipalInertiaOf(const Eigen::Matrix3d& inertia);

}  // namespace simwright::assets
