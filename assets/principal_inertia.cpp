#include "assets/principal_inertia.h"

#include <Eigen/Eigenvalues>

namespace simwright::assets {

PrincipalInertia PrincipalInertiaOf(const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
  Eigen::Matrix3d rotation = axes.eigenvectors();
  if (rotation.determinant() < 0.0) rotation.col(0) *= -1.0;
  return {axes.eigenvalues(), Eigen::Quaterniond(rotation)};
}

}  // namespace simwright::assets
